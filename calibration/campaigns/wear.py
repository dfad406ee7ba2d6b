"""Wear of whole tools over many cycles: test tooth and ripper of [Rojek 2003, 9.2 and 9.3] in full, one page.

    python3 -m calibration.campaigns.wear DIR [CASE ...] [--jobs N | --scheduler ADDRESS]         (make campaign-wear)

All cases, or those named; two runs at a time, or N, or as many as a dask scheduler's workers take; a folder a run. An
interrupted campaign resumes: finished runs are kept, the others continue from their checkpoints. Writes report.html,
wear.md (tables), figures and provenance.json into DIR.
"""
import sys

import matplotlib
import numpy as np

from calibration import generated
from calibration.campaigns.runs import RunFailed, Runs, as_they_end, command_line
from rockwear.kernels.wear_statistics import difference, middles
from rockwear.report import page, plots, published
from rockwear.report.folder import read_history

TOOTH, RIPPER, STEADY = (f"yade_scripts/{name}.py" for name in ("tooth_cycles", "ripper", "steady_cut"))
FEW_PICTURES = dict(snapshot_period=0.0035, checkpoint_interval=300)
LONG = dict(FEW_PICTURES, cycles=28, hardness_temperature=293.15, heat="false")
"""0.201 s as in [Rojek 2003, 9.2], constant hardness."""
IN_ROCK_MASS = dict(
    FEW_PICTURES, grading_factor=1, rock="m_sandstone", discs_per_depth=0, radius_min=1e-3, radius_max=1.5e-3,
    velocity=4, contact_damping=0.9, time_step_fraction=0.8, heat="false", hardness_temperature=293.15,
    hardness_table="MET91", wear_coefficient=0.01128, wear_acceleration=7000, tool_radius_min=0.4e-3)
"""Rock, contacts and steel of the cycles, in a window of a rock mass."""
TOOTH_IN_MASS = dict(
    IN_ROCK_MASS, tooth_height=0.07, tooth_width=0.045, rake=0, clearance=3, tip_radius=4e-3, tool_radius_max=0.52e-3,
    tool_kn=9e10, tool_kt=9e10, depth_of_cut=8e-3, cut_length=0.8, ramp_length=0.02, window_behind=0.04,
    window_ahead=0.08, window_height=0.05)
RIPPER_IN_MASS = dict(
    IN_ROCK_MASS, kn=9e10, kt=9e10, tooth_height=0.085, tooth_width=0.06, rake=25, clearance=12, tip_radius=5e-3,
    tool_radius_max=0.6e-3, tool_kn=2e10, tool_kt=2e10, depth_of_cut=0.015, cut_length=0.56, ramp_length=0.03,
    window_behind=0.05, window_ahead=0.12, window_height=0.07)
CASES = {
    "test tooth, 2e5": (TOOTH, dict(LONG, wear_acceleration=2e5)),
    "ripper, 2e5": (RIPPER, dict(FEW_PICTURES, wear_acceleration=2e5)),
    "ripper, 2e5, depth rule": (RIPPER, dict(FEW_PICTURES, wear_acceleration=2e5, removal="depth")),
    "test tooth, 4e5": (TOOTH, dict(LONG, wear_acceleration=4e5, cycles=14)),
    "test tooth, 8e5": (TOOTH, dict(LONG, wear_acceleration=8e5, cycles=7)),
    "test tooth, 1.6e6": (TOOTH, dict(LONG, wear_acceleration=1.6e6, cycles=3)),
    "test tooth, 8e5, twice as deep": (TOOTH, dict(LONG, wear_acceleration=8e5, cycles=7, depth_of_cut=0.016)),
    "test tooth, 7000": (TOOTH, dict(LONG, wear_acceleration=7000)),
    "ripper, 7000": (RIPPER, dict(FEW_PICTURES)),
    "test tooth, 7000, rock mass": (STEADY, TOOTH_IN_MASS),
    "ripper, 7000, rock mass": (STEADY, RIPPER_IN_MASS),
    "test tooth, 2.5e4": (TOOTH, dict(LONG, wear_acceleration=2.5e4, cycles=8)),
    "test tooth, 5e4": (TOOTH, dict(LONG, wear_acceleration=5e4, cycles=4)),
    "test tooth, 1e5": (TOOTH, dict(LONG, wear_acceleration=1e5, cycles=2)),
}
SAME_WORK = {"a hundredth": ("test tooth, 2.5e4", "test tooth, 5e4", "test tooth, 1e5"),
             "a quarter": ("test tooth, 2e5", "test tooth, 4e5", "test tooth, 8e5", "test tooth, 1.6e6")}
"""First rule of [Rocky]: wear twice as fast and half as long, repeatedly, until the same part is worn off."""
COARSE = dict(grading_factor=3)
"""Rock graded threefold below the reach of the cut: half the time."""
PUBLISHED = 0.203, 100 * published.value("m-9.2-loss")
"""Seconds and per cent of the mass lost [Rojek 2003, 9.2]."""


def profile(run):
    """(b,) m3 worn in each interval along the initial outline."""
    return np.sum(list(read_history(run.path / "wear_profile.csv")[0].values()), axis=1)


def compare(runs):
    """Wear of the same work at several wear accelerations. -> (profiles, differences, expected differences).

    runs: {name: RunFolder}, the slowest first. differences: of each run's distribution of wear from that of the slowest
    run, in %; the expected ones combine the errors that both runs estimate from their own records.
    """
    worn = [profile(run) for run in runs.values()]
    errors = np.array([run.result("wear_distribution_error") for run in runs.values()])
    found = np.array([100 * difference(share, worn[0]) for share in worn])
    return worn, found, 100 * np.hypot(errors, errors[0])


def comparison_figure(runs):
    """Distributions of wear along the tool, and their differences over wear_acceleration. runs: as in `compare`."""
    factors = np.array([run.parameter("wear_acceleration", 1.0) for run in runs.values()])[1:]
    worn, found, expected = compare(runs)
    figure, (along, against) = plots.canvas(12, 4.4, 1, 2)
    place = plots.MM * middles(next(iter(runs.values())).model["outline"], len(worn[0]))
    for name, share in zip(runs, worn):
        along.step(place, 100 * share / share.sum(), where="mid", label=f"{name}: {1e6 * share.sum():.3g} mm² worn")
    reached = place[np.sum([share / share.sum() for share in worn], axis=0) > 1e-3]
    along.set(xlabel="arc length from the tip along the new outline / mm", ylabel="% of the worn volume",
              xlim=(reached.min() - 5, reached.max() + 5))
    along.legend(fontsize=8)
    against.semilogx(factors, found[1:], "o", color="#b5651d", label="difference from the slowest run")
    against.semilogx(factors, expected[1:], "s-", color="#2c6e91", label="expected from both runs' own records")
    against.set(xlabel="wear acceleration, at the same work", ylabel="difference of the distributions / %",
                ylim=(0, None))
    against.set_xticks(factors, [f"{factor:g}" for factor in factors])
    against.set_xticks([], minor=True)
    against.legend(fontsize=8)
    return figure


def comparison_rows(part, runs):
    """Rows of the table of differences. runs: as in `compare`; part: of the tooth that is worn off."""
    return [(part, name, f"{1e6 * share.sum():.3g}", *((f"{off:.0f} %", f"{expected:.0f} %") if k else ("", "")))
            for k, (name, share, off, expected) in enumerate(zip(runs, *compare(runs)))]


def working(run):
    """(rows,) s: time at work up to each row of the history; all of it where a run does not tell."""
    told = run.column("working_time")
    return run.column("time") if np.isnan(told).all() else told


def mass_loss(runs):
    """Mass lost against simulated time, and against working hours."""
    figure, (raw, scaled) = plots.canvas(12, 4.4, 1, 2)
    colours = matplotlib.colormaps["tab20"](np.arange(len(runs)) % 20)
    for (name, run), colour in zip(runs.items(), colours):
        time, whole = run.column("time"), run.model["tool_volumes"].sum()
        worn = 100 * run.column("worn_volume") / whole
        style = dict(color=colour, linestyle="--" if "ripper" in name else "-")
        raw.plot(plots.MS * time, worn, label=name, **style)
        hours = working(run) * run.parameter("wear_acceleration", 1.0) / 3600
        scaled.loglog(hours[worn > 0], worn[worn > 0], **style)
    raw.plot(plots.MS * PUBLISHED[0], PUBLISHED[1], "k*", markersize=12, label="[Rojek 2003, 9.2], k × 7000")
    scaled.plot(PUBLISHED[0] * 7000 / 3600, PUBLISHED[1], "k*", markersize=12)
    raw.set(xlabel="simulated time / ms", ylabel="worn off / % of the tool", yscale="log", ylim=(1e-2, 100))
    scaled.set(xlabel="working time × wear acceleration / h", ylabel="worn off / % of the tool", ylim=(1e-2, 100))
    raw.legend(fontsize=8)
    return figure


def wear_table(runs):
    """(rows, header) with a row for each run: amount and rate of wear, and their reliability."""
    rows = []
    for name, run in runs.items():
        hours = working(run)[-1] * run.parameter("wear_acceleration", 1.0) / 3600
        lost = 100 * run.result("worn_volume") / run.model["tool_volumes"].sum()
        friction, mass = (run.summary["balances"][name] for name in ("friction", "mass"))
        rows.append((name, page.quantity(run.result("simulated_time"), "s"), f"{hours:.2f} h", f"{lost:.3g} %",
                     f"{lost / hours:.2g} %/h", page.quantity(run.result("mean_cutting_force"), "N/m"),
                     page.percent(friction["tool"], run.summary["balances"]["energy"]["tool_work"]),
                     page.percent(run.result("wear_distribution_error"), 1.0),
                     page.number(run.result("trusted_wear_acceleration")),
                     page.percent(mass["unexplained"], mass["archard"])))
    return rows, ("run", "simulated", "stands for", "worn off", "rate", "mean cutting force", "friction, of the work",
                  "error of the distribution", "trusted wear acceleration", "wear against Archard's volume")


COMPARISON_HEADER = "until", "run", "worn, mm²", "difference from the slowest run", "expected"


def comparison_sections(folder, found):
    """(sections of the page, rows of the table) on the same work at several wear accelerations; found: {name: run}."""
    sections, rows = [], []
    for part, names in SAME_WORK.items():
        runs = {name: found[name] for name in names if name in found}
        if len(runs) > 1:
            path = folder / f"acceleration_{part.replace(' ', '_')}.png"
            comparison_figure(runs).savefig(path)
            generated.record(path)
            rows += comparison_rows(part, runs)
            sections.append(page.Section(f"Effect of wear acceleration: until {part} of the tooth is worn off",
                                         "[Rocky]: the same work at other factors must give the same wear.",
                                         [page.image(path)]))
    return sections, rows


def main(folder, *names, **where):
    """Run the missing ones of the named cases (default: all) and write the page; where: options of Runs.

    -> exit code; 1: a run failed.
    """
    cases = {name: CASES[name] for name in names or CASES}
    with Runs(folder, keep=True, **where) as runs:
        waiting = {name: runs.start(name.replace(", ", "-").replace(" ", "_"), script, **{**COARSE, **values})
                   for name, (script, values) in cases.items()}
        name_of = {future: name for name, future in waiting.items()}
        failed = {name_of[one]: str(one.exception()) for one in as_they_end(name_of) if one.exception()}
        found = {name: future.result() for name, future in waiting.items() if name not in failed}
    for words in failed.values():
        print(f"wear campaign: {words}", file=sys.stderr)
    if not found:
        return 1
    with matplotlib.rc_context(plots.STYLE):
        mass_loss(found).savefig(folder / "mass_loss.png")
        compared, differences = comparison_sections(folder, found)
    rows, header = wear_table(found)
    sections = [page.Section("Rate of wear", "Left as simulated, right over the working time times wear acceleration: "
                             "equal rates coincide. The star is the test tooth of [Rojek 2003, 9.2].",
                             [page.image(folder / "mass_loss.png"), page.table(rows, header)]), *compared]
    generated.write_page(folder / "wear.md", [*generated.table(header, rows), *(
        generated.table(COMPARISON_HEADER, differences) if differences else ())])
    for name, run in found.items():
        pieces = [page.image(run.path / "figures" / f"{figure}.png") for figure in ("shape", "wear", "trust")
                  if (run.path / "figures" / f"{figure}.png").exists()]
        sections.append(page.Section(name, "", pieces))
    sections += [page.Section(name, f"FAILED: {words}", [" "]) for name, words in failed.items()]
    (folder / "report.html").write_text(page.document("wear", f"{len(found)} runs, {len(failed)} failed", sections),
                                        encoding="utf-8")
    generated.record(folder / "mass_loss.png", folder / "report.html")
    print(folder / "report.html")
    return 1 if failed else 0


if __name__ == "__main__":
    matplotlib.use("Agg")
    place, words, where = command_line(__spec__.name, CASES, flags=())
    try:
        sys.exit(main(place, *words, **where))
    except RunFailed as error:
        sys.exit(f"wear campaign: {error}")

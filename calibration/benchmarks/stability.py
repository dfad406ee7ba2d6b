"""The critical time step on hard cases, beside YADE's actual limit and the steps that its own estimators allow.

    python3 -m calibration.benchmarks.stability DIR

Runs calibration/benchmarks/stability_runs.py; writes stability.md, stability.png, stability.html and provenance.json
into DIR. `rows` evaluates a run for calibration/validation too.
"""
import sys
import time

import matplotlib
import numpy as np

from calibration import command, generated
from calibration.campaigns.runs import Runs
from calibration.validation.verdicts import Row, Section
from rockwear.kernels.stability import critical_time_step
from rockwear.model.rock import Specimen
from rockwear.report import page, plots

SCRIPT = "calibration/benchmarks/stability_runs.py"
FRACTION = 0.8
"""Of the critical step, the default of the cut; YADE's GlobalStiffnessTimeStepper has the same default."""
BELOW, ABOVE = 0.98, 1.05
"""Fractions of the critical step at which a run must stay bounded, and at which it must become unstable."""
BOUNDED, UNSTABLE = 2 / (1 - BELOW), 1e8
"""Kinetic energy over the initial one: upper bound (with a margin of 2) if stable, lower bound if unstable."""

HEADER = ["case", "particles", "bonds a particle", "critical step, µs", "at 0.98", "at 1.05", "YADE's limit",
          "GlobalStiffness", "in its first step", "P wave", "gain over GlobalStiffness", "over P wave"]
WORDS = (
    "Steps are fractions of the kernel's critical step, which agrees with YADE's limit (by bisection) to 1e-3. A "
    "choice above 1 is unsafe: the run becomes unstable. GlobalStiffness is YADE's GlobalStiffnessTimeStepper with its "
    "timestepSafetyCoefficient of 0.8 (at 1.0 all its numbers grow by a quarter); in its first step it ignores bonds "
    "that carry no force yet, and takes 0.8 of the P wave's step where no bond carries any. P wave is "
    "utils.PWaveTimeStep, with the modulus E = kn/mean radius for which YADE's own springs would have this stiffness; "
    "utils.RayleighWaveTimeStep with Poisson's ratio 0.25 is 5.4 times as long in each case. Gain: speed at 0.8 of the "
    "critical step over theirs, where theirs is safe.")


def rows(cases):
    """(quantity, expected, found, allowed, unit): the conditions that each case of a run's summary must meet.

    Growth of energy is given as its decimal logarithm.
    """
    most = decades(BOUNDED)
    for name, case in cases.items():
        yield f"{name}: decades of energy gained in 2000 steps at 0.98", 0.0, decades(case["below"]), most, ""
        yield f"{name}: unstable at 1.05", 1.0, float(unstable(case["above"])), 0.0, ""
        if "limit" in case:
            yield f"{name}: YADE's limit over the critical step", 1.0, case["limit"], 2e-3, ""
        if "below_intact" in case:
            yield f"{name}: decades gained at 0.98 of the intact step", 0.0, decades(case["below_intact"]), most, ""


def decades(growth):
    """Decimal logarithm of the growth of energy; 99 where it overflowed."""
    return float(min(np.log10(growth), 99.0)) if np.isfinite(growth) else 99.0


def unstable(growth):
    """True where energy has grown by UNSTABLE or more, or overflowed."""
    return not growth < UNSTABLE


def parts(case, name):
    """A step chosen by YADE over the critical one."""
    return case[name] / case["critical_step"]


def gain(case, name):
    """Speed at the default step over that at this choice; None where the choice is unsafe."""
    part = parts(case, name)
    return FRACTION / part if part <= 1 else None


def cells(name, case):
    """A row of the table."""
    chosen = [f"{parts(case, choice):.2f}{'' if parts(case, choice) <= 1 else ' unsafe'}"
              for choice in ("global_stiffness", "global_stiffness_at_first", "p_wave")]
    gains = [gain(case, choice) for choice in ("global_stiffness", "p_wave")]
    return [name, case["particles"], f"{case['coordination'] / 2:.1f}", f"{1e6 * case['critical_step']:.4f}",
            "bounded" if case["below"] <= BOUNDED else "GROWS", "unstable" if unstable(case["above"]) else "BOUNDED",
            f"{case['limit']:.4f}" if "limit" in case else "", *chosen,
            *(f"{g:.2f}" if g else "–" for g in gains)]


def remarks(cases):
    """Further results, as sentences."""
    damped = "90 % contact damping, kt = kn/5"
    soft, wide, high = (cases[name] for name in ("softened and broken bonds", "wide radius range", "high coordination"))
    return [
        f"{damped}: with viscEl, which counts the dashpots, GlobalStiffness would choose "
        f"{parts(cases[damped], 'global_stiffness_viscous'):.2f} of the critical step (by its formula: it cannot be "
        "asked itself, as it takes every contact for a ViscElPhys).",
        "The step of the intact rock is safe for the damaged rock too: it is "
        f"{soft['intact_step'] / soft['critical_step']:.2f} of that of softened and broken bonds.",
        "YADE's shear springs are stiffer by (r1 + r2)/distance where particles overlap, and softer across gaps "
        "(avoidGranularRatcheting). Without that the kernel's step would be "
        f"{wide['plain_shear'] / wide['critical_step']:.3f} of YADE's limit for the wide range of radii, and "
        f"{high['plain_shear'] / high['critical_step']:.3f} for bonds across gaps."]


def figure(cases):
    """Every choice over the critical step, the unsafe side shaded."""
    choices = {"p_wave": ("P wave", "s", "#8fa3b5"),
               "global_stiffness_at_first": ("GlobalStiffness, first step", "D", "#d9b778"),
               "global_stiffness": ("GlobalStiffness 0.8", "o", "#2a4d69")}
    drawn, (axes,) = plots.canvas(10, 1.6 + 0.36 * len(cases))
    place = np.arange(len(cases))[::-1]
    for key, (label, marker, colour) in choices.items():
        axes.plot([parts(case, key) for case in cases.values()], place, marker, color=colour, label=label, markersize=8)
    axes.plot([FRACTION] * len(cases), place, "|", color="#b4441e", markersize=16, markeredgewidth=3,
              label="default of rockwear, 0.8")
    measured = [(case["limit"], y) for case, y in zip(cases.values(), place) if "limit" in case]
    if measured:
        axes.plot(*zip(*measured), "|", color="k", markersize=16, markeredgewidth=1.5, label="YADE's limit, measured")
    right = 1.05 * max(parts(case, key) for case in cases.values() for key in choices)
    axes.axvspan(1.0, right, color="#f6dcd2", zorder=-5, linewidth=0)
    axes.text(1.02, len(cases) - 0.45, "unsafe", color="#b4441e")
    axes.set(xlim=(0, right), ylim=(-0.6, len(cases) - 0.1), xlabel="time step over the critical one of the kernel")
    axes.set_yticks(place, list(cases))
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=3)
    return drawn


def large():
    """CPU seconds for the critical step of 92,000 packed discs. -> [(kt/kn, s)], particles, bonds."""
    rock = Specimen(width=0.722, height=0.722, radius_min=1e-3, radius_max=1.5e-3, porosity=0.12, seed=1,
                    bonding_gap=0.0, density=2841)
    times = []
    for kt in (20e9, 4e9):
        began = time.process_time()
        critical_time_step(positions=rock.positions, radii=rock.radii, masses=rock.masses, inertias=rock.inertias,
                           bonds=rock.pairs, kn=20e9, kt=kt, ratcheting_free=True)
        times.append((kt / 20e9, time.process_time() - began))
    return times, rock.count, len(rock.pairs)


def evaluate(runs):
    """Bounded at 0.98, unstable at 1.05, and YADE's own limit, in every case."""
    cases = runs["stability"].summary["cases"]
    return [Row(*row) for row in rows(cases)], {"stability": figure(cases)}


SECTIONS = [Section("Critical time step", "Hard cases below and above the critical step, beside the steps that YADE's "
                    "own estimators allow.", evaluate, {"stability": (SCRIPT, {"bisect": "true"})})]


def main(folder):
    """Run, evaluate and write. -> exit code."""
    folder.mkdir(parents=True, exist_ok=True)
    with Runs(folder) as runs:
        cases = runs.start("runs", SCRIPT, bisect="true").result().summary["cases"]
    times, count, bonds = large()
    notes = remarks(cases) + [f"{count} packed discs with {bonds} bonds: " + ", ".join(
        f"{seconds:.1f} s of CPU at kt/kn = {ratio:g}" for ratio, seconds in times) + "."]
    table = [cells(name, case) for name, case in cases.items()]
    with matplotlib.rc_context(plots.STYLE):
        figure(cases).savefig(folder / "stability.png")
    sections = [page.Section("Cases", WORDS, [page.image(folder / "stability.png"), page.table(table, HEADER)]),
                page.Section("Remarks", "", [f"<p>{remark}</p>" for remark in notes])]
    failed = [row for row in rows(cases) if abs(row[2] - row[1]) > row[3]]
    (folder / "stability.html").write_text(page.document(
        "The critical time step on hard cases", f"{len(cases)} cases, {len(failed)} of their checks fail", sections),
        encoding="utf-8")
    generated.record(folder / "stability.png", folder / "stability.html")
    print(generated.write_page(folder / "stability.md", [WORDS, "", *generated.table(HEADER, table),
                                                         *(f"- {remark}" for remark in notes)]))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(command.folder(__spec__.name, "out/stability")))

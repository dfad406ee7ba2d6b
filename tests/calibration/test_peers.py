"""What a peer is given is what YADE has; what it gives back is compared as it should be."""
import json
import math
import re
import sys

import numpy as np
import pytest

from calibration.benchmarks.peers import STRAIN, PeerFailed, kratos, lammps
from calibration.benchmarks.peers import __main__ as peers
from tests.running import ROOT, run_script

COLUMNS, ROWS, RADIUS = 14, 8, 0.75e-3
SMALL = ["--width", (2 * COLUMNS + 1.5) * RADIUS, "--height", (2.5 + (ROWS - 1) * 3**0.5) * RADIUS,
         "--tooth_height", 9e-3, "--tooth_width", 8e-3, "--start_up", 1e-3, "--steps", 0]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    out = tmp_path_factory.mktemp("peers")
    done = run_script(ROOT / "calibration/benchmarks/peers/cut.py", *map(str, SMALL), "--out", str(out))
    assert done.code == 0, done.stderr
    model = dict(np.load(out / "model.npz"))
    lammps.write(model, out, lammps.CUT, sample=10, timed=60, rest=40)
    kratos.write(model, out, steps=100, sample=10, timed=60)
    return out


def section(text, title):
    """(n, k) numbers of a section of a data file."""
    lines = re.split(rf"^{title}.*\n\n", text, flags=re.MULTILINE)[1].split("\n\n")[0].strip().split("\n")
    return np.array([line.split() for line in lines], float)


def test_the_peer_has_the_discs_and_bonds_of_the_lattice(folder):
    text = (folder / "model.data").read_text(encoding="utf-8")
    atoms, bonds = section(text, "Atoms"), section(text, "Bonds")
    rock = atoms[atoms[:, 2] != lammps.TOOL]
    assert len(rock) == COLUMNS * ROWS
    assert len(bonds) == ROWS * (COLUMNS - 1) + (ROWS - 1) * (2 * COLUMNS - 1)
    places = atoms[:, 5:7]
    ends = bonds[:, 2:].astype(int) - 1
    assert np.linalg.norm(np.subtract(*places[ends.T]), axis=1) == pytest.approx(2 * RADIUS, rel=1e-12)
    # All discs together weigh what the box of rock does: 2500 kg/m3.
    masses = rock[:, 4] * np.pi / 6 * rock[:, 3]**3
    assert masses == pytest.approx(2500 * SMALL[1] * SMALL[3] / len(rock), rel=1e-9)
    assert (rock[rock[:, 6] < 1.05 * RADIUS, 2] == lammps.FIXED).all() and (rock[:, 2] == lammps.FREE).any()
    tool = atoms[atoms[:, 2] == lammps.TOOL]
    assert len(tool) and (tool[:, 3] > 0.8e-3).all() and (tool[:, 3] < 1.04e-3).all()


def test_the_peer_has_the_constants_of_the_bonds(folder):
    kinds = np.array([line.split()[1:] for line in (folder / "bonds.in").read_text(encoding="utf-8").splitlines()],
                     float)
    number = section((folder / "model.data").read_text(encoding="utf-8"), "Bonds")[:, 1].astype(int) - 1
    assert (kinds[:, 1] == 20e9).all() and (kinds[:, 2] == 8e9).all() and (kinds[:, 3:5] == 0).all()
    Fcr, Fcs = kinds[number, 5:7].T
    assert Fcs / Fcr == pytest.approx(1e12 / 3e4)
    # Strengths scatter about Rn; a Weibull distribution of modulus 4 has a coefficient of variation of 0.28.
    assert Fcr.mean() == pytest.approx(3e4, rel=0.06) and 0.2 < Fcr.std() / Fcr.mean() < 0.36
    script = (folder / "cut.in").read_text(encoding="utf-8")
    assert "hooke 20000000000 0 tangential linear_history 8000000000 0 0.83899999999999997" in script
    assert script.count("hooke 90000000000 0 tangential linear_history 90000000000 0 0.29999999999999999") == 2
    assert "move linear 4 0 0" in script


def test_the_force_of_a_strained_bond_is_exact(folder):
    model = np.load(folder / "model.npz")
    i, j = model["pairs"].T
    delta = model["positions"][j] - model["positions"][i]
    exact = 20e9 * (np.linalg.norm(delta + delta @ STRAIN.T, axis=1) - np.linalg.norm(delta, axis=1))
    # Differences of places of 1e-2 m are known to 1e-18 m.
    assert np.load(folder / "stretch.npy") == pytest.approx(exact, abs=20e9 * 1e-17)


@pytest.mark.parametrize(("kn", "kt", "nu"), [(20e9, 20e9, 0), (20e9, 8e9, 0.75), (5e9, 1e9, 8 / 9)])
def test_kratos_has_the_springs_of_the_bonds(kn, kt, nu):
    E, found = kratos.elastic_constants(kn, kt, RADIUS)
    assert found == pytest.approx(nu)
    # As DEM_KDEM_CL.cpp has it: equivalent radius and moduli of two equal discs.
    modulus, shear = E / (2 * (1 - nu**2)), E / (2 * (1 + nu)) / (2 * (2 - nu))
    assert 1.432 * modulus * math.pi * 0.31225 * RADIUS / 2 == pytest.approx(kn)
    assert 4 * shear * kn / modulus == pytest.approx(kt)


def test_kratos_has_discs_bonds_and_tool_of_the_model(folder):
    model, arrays = np.load(folder / "model.npz"), np.load(folder / "kratos.npz")
    job = json.loads((folder / "kratos.json").read_text(encoding="utf-8"))
    for name in ("positions", "radii", "fixed", "pairs", "tool_positions", "tool_radii"):
        assert (arrays[name] == model[name]).all()
    phi = math.atan(job["of_rock"]["CONTACT_INTERNAL_FRICC"])
    assert 2 * arrays["tau"] * math.cos(phi) / (1 + math.sin(phi)) == pytest.approx(model["Rn"], rel=1e-9)
    assert (arrays["tau"] > 1e5 * model["Rn"]).all()
    assert job["disc"]["PARTICLE_DENSITY"] * math.pi * RADIUS**2 == pytest.approx(model["masses"], rel=1e-12)
    assert job["settings"]["MaxTimeStep"] == model["time_step"] and job["tool_velocity"] == 4
    springs = [[job[of][name] for name in ("K_NORMAL", "K_TANGENTIAL", "STATIC_FRICTION", "DYNAMIC_FRICTION")]
               for of in ("of_rock", "of_tool")]
    assert springs == [[20e9, 8e9, 0.839, 0.839], [90e9, 90e9, 0.3, 0.3]]
    assert [job[name] for name in ("steps", "sample", "timed")] == [100, 10, 60]


def test_kratos_refuses_bonds_with_springs_of_their_own(folder, tmp_path):
    model = dict(np.load(folder / "model.npz"))
    with pytest.raises(PeerFailed, match="one radius, mass, kn and kt"):
        kratos.write({**model, "kn": model["kn"] * np.linspace(1, 2, len(model["kn"]))}, tmp_path)


def test_a_script_of_kratos_that_fails_is_one_line(tmp_path):
    """This Python has no Kratos."""
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin/python").symlink_to(sys.executable)
    with pytest.raises(PeerFailed, match="^Kratos ended with 1: ModuleNotFoundError: No module named 'Kratos.*'$"):
        kratos.run(tmp_path, tmp_path)


def test_kratos_is_timed_over_the_first_steps_and_strained_without_a_tool(folder, tmp_path, monkeypatch):
    model = dict(np.load(folder / "model.npz"))
    monkeypatch.setattr(kratos, "run", lambda environment, folder: {"rows": [[0, 1, 2, 3]], "seconds": 4e-3,
                                                                    "forces": [5, 6]})
    rows, seconds = kratos.cut(tmp_path, model, tmp_path, steps=1100, sample=100)
    assert rows.tolist() == [[0, 1, 2, 3]] and seconds == 4e-3
    assert json.loads((tmp_path / "kratos.json").read_text(encoding="utf-8"))["timed"] == 1000
    assert kratos.stretched(tmp_path, model, tmp_path, STRAIN).tolist() == [5, 6]
    job = json.loads((tmp_path / "kratos.json").read_text(encoding="utf-8"))
    assert job["strain"] == STRAIN.tolist() and job["settings"]["ContactMeshOption"]
    assert len(np.load(tmp_path / "kratos.npz")["tool_radii"]) == 0


def test_agreement_ends_where_the_forces_part():
    ours = np.array([[0, 0, 0, 9], [10, -100, 10, 9], [20, -200, 10, 8], [30, -200, 10, 7], [40, 0, 0, 3]], float)
    theirs = ours + [[0, 0, 0, 0], [0, 0.1, 0, 0], [0, 1, 0, 0], [0, 20, 0, -1], [0, 0, 0, -2]]
    found = peers.agreement(ours, theirs)
    assert found["first_break"] == pytest.approx(0.1 / np.hypot(100, 10))
    assert found["step"] == 20 and found["broken_then"] == [1, 1] and found["broken"] == [6, 8]
    assert found["mean_force"] == pytest.approx([100, 95.78])


@pytest.mark.parametrize("peer", peers.PEERS)
def test_a_peer_that_cannot_be_installed_is_one_line(tmp_path, monkeypatch, capsys, peer):
    monkeypatch.setattr(peers.sys, "executable", str(tmp_path / "nowhere"))
    assert peers.main([peer, str(tmp_path)]) == 1
    said = capsys.readouterr().err
    assert said.startswith("peers: ") and said.count("\n") == 1


LOG = """Step c_force[1] c_force[2] c_sum
     0  0  0  20
   100 -1.5e+03  2  20
  1000 -200  3  18
Loop time of 2.5 on 1 procs for 1000 steps with 10 atoms
99.0% CPU use with 1 MPI tasks x 1 OpenMP threads
  1000 -200  3  18
  1100 -100  4  16
Loop time of 7.5 on 1 procs for 100 steps with 10 atoms
50.0% CPU use with 1 MPI tasks x 1 OpenMP threads
"""


def test_the_peer_is_timed_over_the_first_steps(tmp_path, monkeypatch):
    asked = {}
    monkeypatch.setattr(lammps, "write", lambda model, folder, job, **options: asked.update(options))
    monkeypatch.setattr(lammps, "run", lambda environment, folder: LOG)
    rows, seconds = lammps.cut(tmp_path, {}, tmp_path, steps=1100, sample=100)
    assert asked == {"sample": 100, "timed": 1000, "rest": 100} and seconds == pytest.approx(2.5 * 0.99 / 1000)
    assert rows.tolist() == [[0, 0, 0, 10], [100, -1500, 2, 10], [1000, -200, 3, 9], [1100, -100, 4, 8]]


def test_the_page_tells_forces_and_the_cost_of_the_first_steps():
    ours = np.array([[0, 0, 0, 9], [200, -1e5, 2e4, 9], [500, -2e5, 1e4, 7], [3000, 0, 0, 3]], float)
    theirs = ours + [[0, 0, 0, 0], [0, 0, 0, 0], [0, 1e3, 0, -1], [0, 0, 0, 0]]
    result = {"name": "LAMMPS", "peer": "peer", "steps": 3000, "stretch": 1e-16,
              "agreement": peers.agreement(ours, theirs),
              "seconds_a_step": {"rockwear": [2e-3, 4e-3], "yade": [1e-3, 2e-3], "peer": [1e-3, 1e-3]},
              "rows": {"rockwear": ours.tolist(), "peer": theirs.tolist()},
              "model": {"discs": 5, "bonds": 9, "tool": 2, "velocity": 4.0, "time_step": 1e-7, "steps_a_metre": 3.6e6}}
    text = "\n".join(peers.page(result))
    assert "| 200 | 100 and 100 | 20 and 20 | 0 and 0 |\n| 500 | 200 and 199 | 10 and 10 | 2 and 3 |" in text
    assert text.startswith("# The same cut in LAMMPS\n")
    assert "of the first 1000 steps, means of 2 turns" in text
    assert "| YADE with rockwear | 3 ± 1 | 3.33e+05 ± 1.1e+05 | 3 ± 1 | 3 ± 1 |" in text
    assert peers.drawn(result)

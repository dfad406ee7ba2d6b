"""The steady cuts of campaigns.steady_cut: rocks and causes, and the parameters of each run."""
from rockwear.kernels.cut_sizes import cut_sizes

SCRIPT, UNIAXIAL = "yade_scripts/steady_cut.py", "yade_scripts/uniaxial.py"
BASE, FOUR, EIGHT, FINEST = "base", "four discs", "eight discs", "32 discs"
ENDS_FREE = f"{EIGHT}, ends free"
LOW = "window 4 depths high"
"""Two thirds of the default."""
SHARP = "tip 0.2 mm"
EIGHT_SHARP = f"{EIGHT}, {SHARP}"
SCRATCH = "scratch"
"""In grains of a sandstone's size, which break, at the rake of scratches."""
DEEPER = f"{SCRATCH}, twice as deep"
SEEDS, MORE_SEEDS = (1, 2, 3), (1, 2, 3, 4, 5, 6)
"""Packings of each case, and of those at FLATS_DEPTH."""
ROCK = dict(rock="crushing_sandstone")
CUT = dict(depth_of_cut=5e-3, discs_per_depth=16, rake=-5.0, velocity=8.0, snapshot_period=5e-4, cut_length=0.06,
           time_step_fraction=0.9, heat="true")
SHORT, LONG = 0.03, 0.2
"""m of way with small discs, and with those by which causes are told: 40 depths, so that three packings together know
the mean force to a tenth."""
HALF = dict(cut_length=0.1)
"""Of what is to change little."""
SLOWER = dict(velocity=4.0, snapshot_period=1e-3)
"""Half as fast, with as many pictures over the way."""
FLATS_DEPTH = 1.25e-3
"""m, at which the groove is left near the tool's path: a flat rubs there, as on scratches."""
DEPTHS = 0.3125e-3, FLATS_DEPTH, 0.02
"""m of other cuts, all lengths of which follow their depth: 16 and 4 times less, and 4 times more."""
BOX = dict(width=0.02, height=0.01)
"""Of the laboratory, m; loaded along its length; as much larger or smaller as the discs are."""
SPEEDS = {"compression": 0.04, "tension": 0.02}
"""Of each platen, m/s."""


def at_depth(depth):
    """Parameters of a cut that is as CUT, but for its size. depth: m."""
    size = depth / CUT["depth_of_cut"]
    return dict(depth_of_cut=depth, tip_radius=5e-4 * size, cut_length=CUT["cut_length"] * size,
                snapshot_period=CUT["snapshot_period"] * size)


def strengths_times(factor):
    """Bonds of ROCK with strengths so many times theirs, and the same lengths K^2 / strength^2."""
    return dict(bond_tension=3e6 * factor, bond_cohesion=8.5e6 * factor, bond_crushing=480e6 * factor,
                bond_fracture_energy=90.0 * factor**2, bond_shear_energy=1000.0 * factor**2)


def depth_case(depth):
    """Name of the case at this depth of cut (m)."""
    return f"{EIGHT}, depth {1e3 * depth:.2g} mm"


COARSE = dict(ROCK, discs_per_depth=8, cut_length=LONG)
REAL_GRAINS = dict(grain_edge=2e-4, grain_strength=3.0, rake=-20.0)
ROCKS = {
    BASE: ROCK,
    EIGHT: COARSE,
    FOUR: dict(COARSE, discs_per_depth=4),
    FINEST: dict(ROCK, discs_per_depth=32),
    **{depth_case(depth): {**COARSE, **at_depth(depth)} for depth in DEPTHS},
    SCRATCH: {**COARSE, **at_depth(DEPTHS[0]), **REAL_GRAINS},
    DEEPER: {**COARSE, **at_depth(2 * DEPTHS[0]), **REAL_GRAINS, "discs_per_depth": 16,
             "tip_radius": at_depth(DEPTHS[0])["tip_radius"]},
    **{f"{EIGHT}, {name}": {**COARSE, **change} for name, change in {
        "strengths halved": strengths_times(0.5),
        "strengths times 1.4": strengths_times(1.4),
        "bentheim": dict(rock="bentheim"),
        "medium_sandstone": dict(rock="medium_sandstone"),
        "p_sandstone": dict(rock="p_sandstone"),
        "no crushing": dict(bond_crushing=0.0),
        "crushing 150 MPa": dict(bond_crushing=150e6),
        "no grains": dict(grain_edge=0.0),
        "grains of 1.6 mm, 3 times as strong": dict(HALF, grain_edge=1.6e-3, grain_strength=3.0),
        "grains of 1.6 mm, 6 times as strong": dict(HALF, grain_edge=1.6e-3, grain_strength=6.0),
        "grains of 1.6 mm, 3 times as strong, fracture energy 16": dict(
            HALF, grain_edge=1.6e-3, grain_strength=3.0, bond_fracture_energy=16.0),
        "grains of 3.2 mm, 3 times as strong": dict(HALF, grain_edge=3.2e-3, grain_strength=3.0),
        "Weibull modulus 2": dict(weibull_modulus=2.0),
        "bonding gap 0.075 mm": dict(HALF, bonding_gap=7.5e-5),
        "bonds 1.5 times as stiff": dict(HALF, kn=19.5e9, kt=7.8e9),
        "fracture energy 30": dict(bond_fracture_energy=30.0),
        "fracture energy 5": dict(bond_fracture_energy=5.0)}.items()}}
"""Rocks that are cut as the base is, at other depths of cut too: finer discs make another rock."""
HALVED, STRONGER, BENTHEIM, MEDIUM, PADOVA, NO_GRAINS, WIDER = (f"{EIGHT}, {name}" for name in (
    "strengths halved", "strengths times 1.4", "bentheim", "medium_sandstone", "p_sandstone", "no grains",
    "bonding gap 0.075 mm"))
THAT_BREAK = tuple(case for case in ROCKS if "times as strong" in case)
"""Larger grains than those of the base, which break."""
UNTESTED = SCRATCH, DEEPER
"""Rocks without a laboratory test of their own: a specimen of so many such grains is too large for these speeds."""
PULLED = BASE, HALVED, STRONGER, BENTHEIM, MEDIUM, PADOVA, WIDER, *THAT_BREAK
"""Rocks that are pulled in the laboratory, too; the others have the bonds of the base."""
CHANGES = {
    "velocity 4 m/s": SLOWER,
    "velocity 2 m/s": dict(velocity=2.0, snapshot_period=2e-3),
    "window twice as large": dict(HALF, window_behind=0.024, window_ahead=0.08, window_height=0.06),
    "window 1.5 times as long": dict(window_behind=0.018, window_ahead=0.06),
    LOW: dict(window_height=0.02),
    "window 8 depths high": dict(window_height=0.04),
    "window 5 depths ahead": dict(window_ahead=0.025),
    "boundary fixed": dict(boundary="fixed"),
    "ends free": dict(HALF, boundary="free"),
    "rake -15°": dict(rake=-15.0),
    "rake 15°": dict(rake=15.0),
    "clearance 20°": dict(clearance=20.0),
    SHARP: dict(tip_radius=2e-4),
    "wear flat 1 mm": dict(wear_flat=1e-3),
    "wear flat 2 mm": dict(wear_flat=2e-3),
    "wear flat 2 mm leaning by 5°": dict(HALF, wear_flat=2e-3, flat_angle=5.0),
    "tool friction 0.6": dict(tool_mu=0.6),
    "not damped": dict(background_damping=0.0),
    "damping 5000 1/s": dict(background_damping=5e3),
    "damping 30000 1/s": dict(background_damping=3e4),
    "grains not damped": dict(grain_quality=0.0),
    "stiffer tool contact, step 0.8": dict(tool_kn=1e10, tool_kt=1e10, contact_damping=0.2, time_step_fraction=0.8),
    "rock not graded": dict(HALF, grading_factor=1.0),
    "step 0.45": dict(HALF, time_step_fraction=0.45),
    "step 0.95": dict(HALF, time_step_fraction=0.95),
    "2 m/s, cut 4 times as fast": dict(HALF, velocity=2.0, time_scale=4.0, snapshot_period=2e-3),
    "wear 300 times as fast": dict(HALF, wear_acceleration=300.0),
}
"""How else the rock of eight discs is cut: a seventh of the cost of sixteen."""
RAKES = "rake -15°", "rake 15°"
FLAT = dict(wear_flat=2e-4)
"""Of a scratch."""
CUTS = {**{f"{EIGHT}, {name}": change for name, change in CHANGES.items()},
        **{f"{EIGHT_SHARP}, {name}": {**CHANGES[SHARP], **CHANGES[name]} for name in RAKES},
        **{f"{depth_case(FLATS_DEPTH)}, {name}": CHANGES[name] for name in ("wear flat 1 mm", "wear flat 2 mm")},
        **{f"{SCRATCH}, {name}": change for name, change in {
            "wear flat 0.2 mm": FLAT,
            **{f"wear flat 0.2 mm leaning by {angle}°": dict(FLAT, flat_angle=angle) for angle in (2, 5, 10)},
            "velocity 2 m/s": dict(velocity=2.0, snapshot_period=1.25e-4),
            "tool friction 0.6": CHANGES["tool friction 0.6"],
            "tool friction 0.6, wear flat 0.2 mm leaning by 5°": dict(FLAT, flat_angle=5,
                                                                      **CHANGES["tool friction 0.6"])}.items()},
        **{name: CHANGES[name] for name in ("wear flat 2 mm", "velocity 4 m/s", LOW)}}
"""How else the rock that a case begins with is cut, or that of the base."""
SETTINGS = BASE, FINEST, LOW, FOUR, EIGHT, *(f"{EIGHT}, {name}" for name in (
    LOW, "window 8 depths high", "window 1.5 times as long", "boundary fixed", "stiffer tool contact, step 0.8",
    "rock not graded", "step 0.45", "step 0.95"))
"""Cases that cut the same rock with the same tool: they differ in what they cost. (A slower one is another cut. A
window of 5 depths ahead is none: it takes a third of the friction, by which it seems nearer to sixteen discs.)"""
OF_THE_CUT = {"discs_per_depth", "rake", *at_depth(1.0)}
"""Parameters of a rock of ROCKS that the laboratory does not take."""
AT_DEPTHS = *map(depth_case, DEPTHS[:2]), EIGHT, depth_case(DEPTHS[2])
"""Cases that differ in size alone, by their depth of cut."""
CASES = [BASE, *[name for name in ROCKS if name != BASE], *CUTS]


def slug(*words):
    """Name of a folder."""
    return "-".join("".join(c if c.isalnum() or c in "-." else "_" for c in str(word)) for word in words)


def rock_of(case):
    """The rock that a case cuts."""
    return max((rock for rock in ROCKS if f"{case}, ".startswith(f"{rock}, ")), key=len, default=BASE)


def seeds_of(case):
    """Packings that are cut."""
    return MORE_SEEDS if depth_of(case) == FLATS_DEPTH else SEEDS


def cut_of(case, seed):
    """Parameters of a cut."""
    length = dict(cut_length=SHORT) if case == FINEST else {}
    return {**CUT, **length, **ROCKS[rock_of(case)], **CUTS.get(case, {}), "seed": seed, "report": "false"}


def tests_of(rock):
    """Names of its laboratory tests."""
    if rock in UNTESTED:
        return []
    return list(SPEEDS) if rock in PULLED else ["compression"]


def test_of(rock, test, seed):
    """Parameters of a laboratory test: discs as in the cut, and a specimen that is as much larger as they are."""
    sizes, base = (cut_sizes(case["depth_of_cut"], case["discs_per_depth"], velocity=CUT["velocity"])
                   for case in ({**CUT, **ROCKS[rock]}, CUT))
    factor = sizes["radius_min"] / base["radius_min"]
    return {**{name: factor * length for name, length in BOX.items()},
            **{name: sizes[name] for name in ("radius_min", "radius_max")},
            **{name: value for name, value in ROCKS[rock].items() if name not in OF_THE_CUT},
            "test": test, "speed": SPEEDS[test], "seed": seed, "snapshot_period": 1, "report": "false"}


def plan(cases):
    """{folder: (script, parameters)}, the base and one packing of each case first."""
    found = {}
    for case, seed in sorted(((case, seed) for case in cases for seed in seeds_of(case)),
                             key=lambda job: (job[0] != BASE, job[1], CASES.index(job[0]))):
        rock = rock_of(case)
        found[f"cut/{slug(case, seed)}"] = SCRIPT, cut_of(case, seed)
        for test in tests_of(rock):
            found[f"lab/{slug(rock, test, seed)}"] = UNIAXIAL, test_of(rock, test, seed)
    return found


def depth_of(case):
    """m."""
    return {**CUT, **ROCKS[rock_of(case)]}["depth_of_cut"]


def changed_from(case):
    """The case that this one differs from in one cause; None for those of other discs or depths."""
    known = max((one for one in CASES if case.startswith(f"{one}, ")), key=len, default=BASE if case in CUTS else None)
    return known if known and depth_of(known) == depth_of(case) else None

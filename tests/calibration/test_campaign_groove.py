"""make campaign-groove: what is cut at the tool's sides, and what has come off, of runs whose answer is known."""
import json

import numpy as np
import pytest

from calibration.campaigns import groove

SLICE, SIDES = 50e3, 300.0
"""N/m and N of the made-up cuts."""
SPACING = 1e-3
"""m between the particles of the made-up block, each of which stands for a cube."""


def made_up(folder, seed_factor=lambda seed: 1.0):
    """Runs of the whole plan: forces of a slice and of the sides, a groove 2 mm wider than the tool on either side and
    1 mm deeper than its path, between 5 mm and the end of the way."""
    for (_, case, seed), (place, _, values) in groove.plan(["0.9"]).items():
        run = folder / place
        (run / "snapshots").mkdir(parents=True)
        (run / "summary.json").write_text(json.dumps({
            "results": {"peak_stress": {"value": 5e7 + 1e6 * seed}, "fracture_toughness": {"value": 1e6 + 1e5 * seed}},
            "parameters": values, "versions": {"rockwear": "0"},
            "balances": {"energy": {"tool_work": 10.0, "residual": -0.05}}}), encoding="utf-8")
        if not isinstance(case, str):
            continue
        force = (SIDES + SLICE * values["breadth"]) * seed_factor(seed)
        time = np.linspace(0.0, values["cut_time"], 400)
        way = values["velocity"] * time
        rows = np.column_stack([time + 1e-3, np.ones(400), np.full(400, force), np.full(400, 0.5 * force),
                                0.1 * force * way])
        header = "time [s],stage [-],cutting_force [N],thrust_force [N],tool_friction [J]"
        np.savetxt(run / "history.csv", rows, delimiter=",", header=header, comments="", fmt="%.9g")
        block(run, values)


def block(run, values):
    """A block of particles on a square lattice, each bonded to the one below it, but for those in the groove. Those
    of them that the tool meets or that lie right below it go twice the depth of cut away, the others half of it."""
    size = [values[name] for name in ("width", "height", "depth")]
    counts = [round(length / SPACING) for length in size]
    places = SPACING * (np.indices(counts).reshape(3, -1).T + 0.5)
    number = np.arange(len(places)).reshape(counts)
    bonds = np.stack([number[:, :-1], number[:, 1:]], axis=-1).reshape(-1, 2)
    places[:, 2] -= 0.5 * size[2]
    gone = (np.abs(places[:, 2]) < 0.5 * values["breadth"] + 2e-3) & (places[:, 0] > 2e-3)
    gone &= places[:, 1] > values["height"] - values["depth_of_cut"] - 1e-3
    np.savez(run / "model.npz", rock_radii=np.full(len(places), SPACING / 2), rock_fixed=places[:, 1] < SPACING,
             bonds=bonds, block=size)
    far = gone & (np.abs(places[:, 2]) < 0.5 * values["breadth"])
    way = values["depth_of_cut"] * (0.5 * gone + 1.5 * far)
    for number, status in enumerate((np.zeros(len(bonds)), gone[bonds].any(axis=1))):
        np.savez(run / "snapshots" / f"{number:04d}.npz", time=float(number), stage=1, status=status.astype(np.int8),
                 rock_positions=places + number * way[:, None] * [0.6, 0.0, 0.8])


def test_force_at_the_sides_and_of_a_slice(tmp_path):
    made_up(tmp_path)
    a_slice, sides = groove.sides(groove.measured(tmp_path)[0]["0.9"])
    assert a_slice.value == pytest.approx(1e-3 * SLICE, rel=1e-6) and sides.value == pytest.approx(1e-3 * SIDES)


def test_packings_scatter(tmp_path):
    made_up(tmp_path, lambda seed: 1 + 0.1 * (seed - 2))
    a_slice, sides = groove.sides(groove.measured(tmp_path)[0]["0.9"])
    assert a_slice.value == pytest.approx(1e-3 * SLICE, rel=1e-6)
    assert a_slice.standard_error == pytest.approx(1e-4 * SLICE / np.sqrt(3), rel=1e-6)
    assert sides.standard_error == pytest.approx(1e-4 * SIDES / np.sqrt(3), rel=1e-6)


def test_section_of_the_groove_and_what_came_off_below_the_path(tmp_path):
    """Particles off fill whole columns: the sections are exact where the breadth is so many of them."""
    made_up(tmp_path)
    for name, breadth in (("13", 13e-3), ("26", 26e-3)):
        (values, *_) = [groove.of_run(groove.RunFolder(tmp_path / f"cut/0.9-{name}-{seed}")) for seed in groove.SEEDS]
        wide = round((breadth + 4e-3) / SPACING) * SPACING
        assert values["section"].value == pytest.approx(wide * 6e-3 / (breadth * 5e-3), rel=1e-6)
        assert values["overbreak"].value == pytest.approx(wide * 1e-3 / (breadth * 5e-3), rel=1e-6)
        assert values["carried_off"].value == pytest.approx(1.2) and values["carried_below"].value == pytest.approx(0.2)
        assert values["thrust"].value == pytest.approx(0.5) and values["missed"].value == pytest.approx(-0.005)
        assert values["energy"].value == pytest.approx(1e-6 * (SIDES / breadth + SLICE) / 5e-3)


def test_slower_tools_go_as_far_in_the_larger_spheres():
    slow = {(radius, case): values for (radius, case, _), (_, _, values) in groove.plan(groove.RADII).items()
            if case in groove.SLOWER}
    assert set(slow) == {("0.9", case) for case in groove.SLOWER}
    for (_, case), values in slow.items():
        assert values["velocity"] == values["lowering_velocity"] == groove.SLOWER[case] and values["breadth"] == 0.013
        assert values["rock"] == (groove.GRAINY if groove.GRAINY in case else groove.ROCK)
        assert values["velocity"] * values["cut_time"] == pytest.approx(0.03)
        assert values["velocity"] * values["record_period"] == pytest.approx(4e-5)


def test_other_tools_differ_from_the_base_by_what_they_are_for():
    plan = {(case, seed): values for (radius, case, seed), (_, _, values) in groove.plan(["0.9"]).items()}
    for case, values in groove.OTHERS.items():
        base = plan[groove.GRAINY_BASE if groove.GRAINY in case else groove.BASE, 2]
        assert {name: of for name, of in plan[case, 2].items() if base.get(name) != of} == values
    deep = plan["13, 10 deep", 1]
    assert deep["velocity"] * deep["cut_time"] == pytest.approx(6 * deep["depth_of_cut"])
    assert deep["depth"] == pytest.approx(deep["breadth"] + 4 * deep["depth_of_cut"])


def test_a_rock_of_grains_is_cut_by_the_same_tools(tmp_path):
    plan = {(case, seed): values for (_, case, seed), (_, _, values) in groove.plan(["0.6"]).items()}
    for name in groove.BREADTHS:
        rock, grainy = plan[name, 2], plan[f"{name}, {groove.GRAINY}", 2]
        assert {key for key in rock.keys() | grainy.keys() if rock.get(key) != grainy.get(key)} == {"rock"}
    made_up(tmp_path)
    found = groove.measured(tmp_path)[0]["0.9"]
    found = {f"{name}, {groove.GRAINY}": found[name] for name in groove.BREADTHS}
    assert groove.sides(found, groove.OF_GRAINS)[1].value == pytest.approx(1e-3 * SIDES)
    assert not list(groove.changes(found))


def test_less_tough_rocks_are_cut_and_tested():
    """Those of the laboratory and of the cuts are the same; specimens grow with the spheres."""
    plan = groove.plan(groove.RADII)
    for rock, given in groove.ROCKS.items():
        runs = [plan[groove.TOUGH, (test, rock), 2] for test in groove.LABORATORY]
        runs.append(plan[groove.TOUGH, groove.BASE if rock == groove.TOUGHER else f"{groove.BASE}, {rock}", 2])
        for _, _, values in runs:
            assert values["seed"] == 2 and values["radius"] == 9e-4 and values["rock"] == groove.ROCK
            assert {name: of for name, of in values.items() if "energy" in name} == given
    assert plan["0.9", ("toughness", groove.TOUGHER), 1][2]["size"] == pytest.approx(1.5 * 0.0168)
    assert ("0.6", ("toughness", groove.TOUGHER), 1) not in plan


def test_changes_are_those_of_the_same_packings(tmp_path):
    """A case whose force is 0.1 kN higher in two packings that differ by 0.5 kN."""
    made_up(tmp_path)
    found = groove.measured(tmp_path)[0]["0.9"]
    base, case = ({seed: {**one, "force": groove.steady_record.Measured(1.0 + 0.5 * seed + more, 0.02)}
                   for seed, one in found["13"].items()} for more in (0.0, 0.1))
    rows = dict((name, cells) for name, _, *cells in groove.changes({"6.5": found["6.5"], "13": base, "flat": {
        seed: case[seed] for seed in (2, 3)}}))
    assert set(rows) == {"flat"} and rows["flat"][0].startswith("0.1 ± 0.02 (+4 %)")
    slow = f"{groove.GRAINY_BASE}, 2 m/s"
    rows = dict((name, cells) for name, _, *cells in groove.changes({"13": found["13"], groove.GRAINY_BASE: base,
                                                                     slow: case}))
    assert set(rows) == {slow} and rows[slow][0].startswith("0.1 ± ")


def test_the_page(tmp_path, monkeypatch):
    monkeypatch.setattr(groove, "DRAWN", ("0.9", "13"))
    made_up(tmp_path)
    assert groove.main(tmp_path, ["--read"]) == 0
    page = (tmp_path / "groove.md").read_text(encoding="utf-8")
    assert "| 13 | 3 | 0.95 ± " in page and "is 0.3 ± " in page and "50 ± " in page and "UCS 52 ± 0.58 MPa" in page
    # 0.95 kN over 13 x 5 mm are 14.6 MJ/m3.
    assert "| 90 and 1000 J/m2 | 1.2 ± 0.058 | 52 ± 0.58 | 0.95 ± " in page and "| 28.1 ± " in page
    assert "| 3, 3, 3 |" in page
    assert (tmp_path / "groove.png").stat().st_size > 4e4


def test_a_breadth_alone_tells_no_sides(tmp_path):
    made_up(tmp_path)
    found = groove.measured(tmp_path)[0]["0.9"]
    assert np.isnan(groove.sides({"13": found["13"]})[0].value)

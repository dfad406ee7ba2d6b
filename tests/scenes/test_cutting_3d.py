"""Cuts in space, in miniature [Rojek 2003, ch. 13]: balances, Archard's wear, the weight of a fill, resumed runs."""
import signal

import numpy as np
import pytest

from rockwear.model.facet_tool import read_stl, write_stl
from rockwear.kernels.boundary import check_boundary, distance, volume
from rockwear.report.folder import RunFolder, read_history
from rockwear.report.views import wear_triangles
from rockwear.report.views.key_results import wear_tiles

from tests.running import (
    BLOCK, BLOCK_OF_TRIANGLES, ROOT, arguments, assert_as_if_never_stopped, assert_refused, checks_of, history,
    interrupt_script, last_snapshot, refusals, run_script, value)

LOOSE = dict(width=0.3, height=0.08, depth=0.17, scale_factor=1, radius=0.012, breadth=0.04, tooth_height=0.08,
             tooth_width=0.04, depth_of_cut=0.026, freeboard=0.03, settling=0.5, lowering_velocity=0.3, cut_time=0.1,
             start=0.16, facet=0.03)
"""A fill as of [Rojek 2003, 13.1]."""


def scene(name, out, *flags, **values):
    """Run one of the scripts."""
    return run_script(ROOT / f"yade_scripts/{name}.py", *arguments(values), "--out", str(out), *flags, out=out)


def assert_balances_close(run, part):
    energy = run.summary["balances"]["energy"]
    assert energy["tool_work"] > 1 and abs(energy["residual"]) < part * energy["tool_work"]
    friction = run.summary["balances"]["friction"]
    assert friction["worn_by"] == pytest.approx(friction["tool"], rel=1e-9)


@pytest.fixture(scope="module")
def worn(tmp_path_factory):
    """Model II in miniature."""
    run = scene("cutting_3d_wear", tmp_path_factory.mktemp("worn") / "run", "--vtk", **BLOCK)
    assert run.code == 0, run.stderr
    return run


def test_a_tooth_of_particles_breaks_bonds_and_its_work_is_balanced(worn):
    assert value(worn, "tensile_cracks") > 10 and value(worn, "mean_cutting_force") > 0
    assert_balances_close(worn, 0.02)


def test_worn_volume_is_archards_and_none_goes(worn):
    friction = worn.summary["balances"]["friction"]["worn_by"]
    assert value(worn, "worn_volume") == pytest.approx(5e-9 * friction, rel=1e-9, abs=0)
    assert value(worn, "particles_removed") == 0 and value(worn, "mass_lost") == 0
    shot = last_snapshot(worn.out)
    assert shot["worn_depth"].max() == pytest.approx(value(worn, "maximum_wear_depth"), rel=1e-12)
    # Depth is volume over the square of a sphere.
    radii = np.load(worn.out / "model.npz")["tool_radii"]
    assert (shot["worn_depth"] * (2 * radii)**2).sum() == pytest.approx(value(worn, "worn_volume"), rel=1e-9, abs=0)


def test_wear_in_space_is_judged_by_the_rules_of_acceleration(worn):
    columns, units = read_history(worn.out / "wear_profile.csv")
    assert set(units.values()) == {"m3"}
    assert np.sum(list(columns.values())) == pytest.approx(value(worn, "worn_volume"), rel=1e-9, abs=0)
    assert 0 < value(worn, "wear_distribution_error") and value(worn, "trusted_wear_acceleration") > 0
    assert (worn.out / "figures/trust.png").exists()


def test_volumes_have_their_unit(worn):
    assert worn.summary["results"]["worn_volume"]["unit"] == worn.summary["results"]["dropped_volume"]["unit"] == "m3"
    assert read_history(worn.out / "history.csv")[1]["worn_volume"] == "m3"


def test_fewer_samples_of_the_contacts_find_the_same_friction(worn, tmp_path):
    """Each stands for five steps, its springs those of the step before; with older ones 5 % of the friction goes
    astray."""
    run = scene("cutting_3d_wear", tmp_path / "run", sampling_period=5, report="false", **BLOCK)
    assert run.code == 0, run.stderr
    friction, whole = (r.summary["balances"]["friction"]["tool"] for r in (run, worn))
    assert friction != whole and friction == pytest.approx(whole, rel=0.01)
    assert_balances_close(run, 0.02)


def test_no_wear_without_contact_and_none_above_the_cut(worn):
    places = np.load(worn.out / "model.npz")["tool_positions"]
    rubbed = last_snapshot(worn.out)["worn_depth"] > 0
    assert 5 < rubbed.sum() and np.median(places[rubbed, 1]) < BLOCK["depth_of_cut"]


def test_no_heat_engine_and_files_for_paraview(worn):
    assert "heat" not in worn.summary["wall_time"]["by_engine"]
    assert len(list((worn.out / "vtk").glob("tool.*.vtp"))) > 2
    page = (worn.out / "report.html").read_text(encoding="utf-8")
    assert "in perspective" in page and "[Rojek 2003, 13.3]: 0.142 mm" in page


REMOVED = dict(wear_coefficient=3e-8, removal="volume", report="false", **{**BLOCK, "cut_time": 0.05})
AS_PUBLISHED = {name: v for name, v in REMOVED.items() if name not in ("Rn", "Rt", "wear_coefficient", "removal")}
"""With the bonds, the wear constant and the rule of [Rojek 2003, 13.4], the scene's defaults."""


@pytest.fixture(scope="module")
def removed(tmp_path_factory):
    """{rule: run}: particles go as they wear."""
    folder = tmp_path_factory.mktemp("removed")
    return {rule: scene("cutting_3d_removal", folder / rule, **values)
            for rule, values in (("volume", REMOVED), ("depth", AS_PUBLISHED))}


@pytest.mark.parametrize("rule, k, least", [("volume", 3e-8, 10), ("depth", 5e-7, 2)])
def test_particles_go_as_they_wear(removed, rule, k, least):
    run = removed[rule]
    assert run.code == 0, run.stderr
    assert value(run, "particles_removed") > least and value(run, "tensile_cracks") > 10
    mass = run.summary["balances"]["mass"]
    assert mass["archard"] == pytest.approx(7830 * k / 0.1 * run.summary["balances"]["friction"]["worn_by"], rel=1e-9)
    if rule == "volume":
        assert abs(mass["unexplained"]) < 1e-9 * mass["archard"]
    shot, radii = last_snapshot(run.out), np.load(run.out / "model.npz")["tool_radii"]
    assert (shot["worn_depth"][shot["alive"]] < 2 * radii[shot["alive"]]).all()
    assert set(shot["surface"].tolist()) <= set(np.flatnonzero(shot["alive"]).tolist())
    assert_balances_close(run, 0.03)


def test_a_tooth_of_triangles_makes_a_like_cut(tmp_path, worn):
    run = scene("cutting_3d_triangles", tmp_path / "run", report="false", **BLOCK_OF_TRIANGLES)
    assert run.code == 0, run.stderr
    assert_balances_close(run, 0.03)
    assert value(run, "tensile_cracks") > 10 and value(run, "worn_volume") == 0
    assert 0.3 < value(run, "mean_cutting_force") / value(worn, "mean_cutting_force") < 3


BLUNTED = dict(wear_coefficient=3e-9, reshape="true", **BLOCK_OF_TRIANGLES)


@pytest.fixture(scope="module")
def blunted(tmp_path_factory):
    """A tooth of triangles that wears."""
    run = scene("cutting_3d_triangles", tmp_path_factory.mktemp("blunted") / "run", **BLUNTED)
    assert run.code == 0, run.stderr
    return run


def test_triangles_lose_archards_volume_and_do_not_fold(blunted):
    model, shot = np.load(blunted.out / "model.npz"), last_snapshot(blunted.out)
    first, now, facets = model["tool_vertices"], shot["tool_vertices"], shot["tool_facets"]
    mass, friction = (blunted.summary["balances"][name] for name in ("mass", "friction"))
    assert value(blunted, "worn_volume") == pytest.approx(3e-9 / 0.1 * friction["worn_by"], rel=1e-9, abs=0)
    assert mass["archard"] == pytest.approx(7830 * value(blunted, "worn_volume"), rel=1e-12, abs=0)
    gone = 7830 * (volume(first, model["tool_facets"]) - volume(now, facets))
    assert gone + mass["waiting"] == pytest.approx(mass["archard"], rel=1e-9) and gone > 0.9 * mass["archard"]
    assert value(blunted, "mass_lost") == pytest.approx(gone / mass["initial"], rel=1e-9)
    assert value(blunted, "mass_lost") > 0.004
    check_boundary(now, facets)
    assert_balances_close(blunted, 0.03)


def test_one_mode_of_several_wears_and_is_judged_like_archards_law(blunted, tmp_path):
    """Its k stands in the modes; wear_coefficient is 0."""
    run = scene("cutting_3d_triangles", tmp_path / "run", wear_law="modes", wear_modes="3e-9/1/1", reshape="true",
                report="false",
                **BLOCK_OF_TRIANGLES)
    assert run.code == 0, run.stderr
    for name in ("worn_volume", "wear_distribution_error", "trusted_wear_acceleration"):
        assert value(run, name) == pytest.approx(value(blunted, name), rel=1e-6, abs=0)
    assert (run.out / "tool.stl").exists()
    assert wear_tiles(RunFolder(run.out))


def test_contacts_that_pass_to_facets_given_elsewhere_bring_no_energy(tmp_path):
    """The soft contacts of [Rojek 2003, 13.2], worn so much that facets are given elsewhere under particles: not
    counted, they add 2 %."""
    run = scene("cutting_3d_triangles", tmp_path / "run", wear_coefficient=1.5e-7, reshape="true", report="false",
                **{**BLOCK_OF_TRIANGLES, "tool_kn": 1e6, "tool_kt": 1e6, "seed": 2})
    assert run.code == 0, run.stderr
    model, shot = np.load(run.out / "model.npz"), last_snapshot(run.out)
    assert (model["tool_facets"] != shot["tool_facets"]).any() and value(run, "mass_lost") > 0.05
    energy = run.summary["balances"]["energy"]
    assert abs(energy["residual"]) < 0.01 * energy["tool_work"]
    check_boundary(shot["tool_vertices"], shot["tool_facets"])


def test_the_depth_of_wear_is_the_way_from_the_new_surface_to_the_worn_one(blunted):
    model, shot = np.load(blunted.out / "model.npz"), last_snapshot(blunted.out)
    first, now = model["tool_vertices"], shot["tool_vertices"]
    depth = distance(first, now, shot["tool_facets"])
    assert value(blunted, "maximum_wear_depth") == pytest.approx(depth.max(), rel=1e-12)
    assert depth.max() > 1e-3
    assert "deepest_wear" not in blunted.summary["results"]


def test_the_page_shows_where_and_how_deep_triangles_are_worn(blunted):
    assert (blunted.out / "figures/worn_triangles.png").exists()
    page = (blunted.out / "report.html").read_text(encoding="utf-8")
    assert "How far the surface has gone back" in page and "maximum wear depth" in page
    assert "particles removed" not in page
    front, _, bar, whole, near = wear_triangles.figure(RunFolder(blunted.out)).axes
    triangles, = front.collections
    assert len(triangles.get_facecolor()) == value(blunted, "facets")
    # The colours end where the worn surface lies deepest in the new tooth; the new tip may be further away from it.
    shot, model = last_snapshot(blunted.out), np.load(blunted.out / "model.npz")
    below = distance(shot["tool_vertices"], model["tool_vertices"],
                     model["tool_facets"])[shot["tool_facets"]].mean(axis=1)
    assert bar.get_ylim()[1] == pytest.approx(1e3 * below.max()) and bar.get_ylim()[1] > 0.1
    assert len(near.get_legend().get_texts()) == len(whole.collections) == 5


def test_a_worn_tool_goes_out_and_into_the_next_cut(blunted, tmp_path):
    """Wherever the file has its origin, the tool stands where the tooth that it was made of stood."""
    vertices, facets = read_stl(blunted.out / "tool.stl")
    elsewhere = tmp_path / "elsewhere.stl"
    write_stl(elsewhere, vertices + [0.3, 0.05, -0.2], facets)
    run = scene("cutting_3d_triangles", tmp_path / "run", stl=elsewhere, report="false", **OF_A_FILE)
    assert run.code == 0, run.stderr
    worn, fed = (dict(np.load(r.out / "model.npz")) for r in (blunted, run))
    was = last_snapshot(blunted.out)
    first, last = (volume(shape["tool_vertices"], shape["tool_facets"]) for shape in (fed, was))
    assert first == pytest.approx(last, rel=1e-6)
    assert len(fed["tool_facets"]) < 1.3 * len(worn["tool_facets"])
    low, high = fed["tool_vertices"].min(axis=0), fed["tool_vertices"].max(axis=0)
    tip = fed["tool_vertices"][fed["tool_vertices"][:, 1] < 1e-6, 0].max()
    assert (low[1], tip) == pytest.approx((0, -4e-3), abs=1e-6) and low[2] == pytest.approx(-high[2], rel=1e-6)
    assert value(run, "mean_cutting_force") > 1000 and not (run.out / "tool.stl").exists()
    assert_balances_close(run, 0.03)


def test_a_loose_fill_settles_to_its_weight_and_resists_the_tooth(tmp_path):
    run = scene("granular_3d", tmp_path / "run", report="false", **LOOSE)
    assert run.code == 0, run.stderr
    model, shot = np.load(tmp_path / "run/model.npz"), last_snapshot(tmp_path / "run")
    free = ~model["rock_fixed"]
    assert (shot["rock_positions"][free, 1] > 0).all()
    energy = run.summary["balances"]["energy"]
    assert abs(energy["residual"]) < 0.02 * (energy["tool_work"] - energy["potential"])
    columns = history(tmp_path / "run")
    deep = columns["stage [-]"] == 1
    assert columns["thrust_force [N]"][deep].max() > 1
    assert not columns["cutting_force [N]"][columns["stage [-]"] == 0].any()
    assert value(run, "tensile_cracks") == 0


def test_the_box_carries_the_weight_of_the_fill(tmp_path):
    found = checks_of("settled_fill", tmp_path, *arguments({**LOOSE, "settling": 0.6}))
    assert found["on_box"] == pytest.approx(found["weight"], rel=5e-3)
    assert found["kinetic"] < 1e-3 * found["fallen"]


def assert_resumes(whole, out, name, number, after, **values):
    """Stopped by a signal after so many checkpoints and resumed it ends as the run `whole`."""
    # A collider that has lost sight of the rock would resume just as well.
    assert value(whole, "mean_cutting_force") > 1000
    values = {**values, "report": "false", "checkpoint_interval": 0.01}
    stopped = interrupt_script(ROOT / f"yade_scripts/{name}.py", out, number, after, **values)
    assert stopped.code in (-signal.SIGKILL, 128 + signal.SIGTERM)
    assert_as_if_never_stopped(scene(name, out, "--resume", **values), whole, "cracks.csv")


def test_an_interrupted_cut_with_particles_goes_on_bit_for_bit(removed, tmp_path):
    # The steps of the cut are one chunk: the checkpoint is that of the end of the lowering.
    assert_resumes(removed["volume"], tmp_path / "cut", "cutting_3d_removal", signal.SIGKILL, 2, **REMOVED)


def test_an_interrupted_cut_with_triangles_goes_on_bit_for_bit(blunted, tmp_path):
    assert_resumes(blunted, tmp_path / "cut", "cutting_3d_triangles", signal.SIGTERM, 4, **BLUNTED)
    assert np.array_equal(*(last_snapshot(out)["tool_vertices"] for out in (blunted.out, tmp_path / "cut")))


@pytest.mark.parametrize("name, usual, cases", [
    ("cutting_3d_wear", BLOCK, [(dict(cut_time=5), "cut_time = 5"), (dict(tool_radius=0.02), "tool_radius = 0.02")]),
    ("cutting_3d_triangles", BLOCK_OF_TRIANGLES, [
        (dict(sampling_period=2), "sampling_period = 2 steps: must be 1"),
        (dict(facet=1e-6), "facet = 1e-06 m: must be at least 0.0")]),
    ("granular_3d", LOOSE, [(dict(start=0.1), "start = 0.1"), (dict(Rn=1), "Rn = 1")])])
def test_what_cannot_be_is_refused(tmp_path, name, usual, cases):
    words = [arguments({**usual, **values, "out": tmp_path / "out"}) for values, _ in cases]
    found = refusals(ROOT / f"yade_scripts/{name}.py", tmp_path, words)
    for (code, said), (_, expected) in zip(found, cases, strict=True):
        assert_refused(code, said, f"error: {expected}")
    run = scene(name, tmp_path / "out", **{**usual, **cases[0][0]})
    assert_refused(run.code, run.stderr, f"error: {cases[0][1]}")
    assert not (tmp_path / "out").exists()


CUBE = (0.04 * (np.array(list(np.ndindex(2, 2, 2))) - 0.5),
        np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
                  [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]))
"""Vertices and facets of a closed surface, 40 mm wide."""


OF_A_FILE = {name: v for name, v in BLOCK_OF_TRIANGLES.items()
             if name not in ("breadth", "tooth_height", "tooth_width")}
FILES = [
    (None, None, {}, "must be a readable STL file"),
    (1, CUBE[1][:0], {}, "must be a file of triangles"),
    (1, CUBE[1][1:], {}, "3 open edges: must be closed: it has holes"),
    (1, np.vstack([CUBE[1][:1, ::-1], CUBE[1][1:]]), {}, "must be of one orientation"),
    (1, CUBE[1][:, ::-1], {}, "must be oriented with its normals outwards"),
    (1, np.vstack([CUBE[1], 8 + CUBE[1]]), {}, "2 separate surfaces: must be one piece"),
    (1, np.tile(CUBE[1], (1700, 1)), {}, "20400 triangles: must be a tool of at most 20000"),
    (1000, CUBE[1], {}, "40 x 40 x 40 m: must be shorter and narrower than the block, 0.28 x 0.1 x 0.16"),
    (0.5, CUBE[1], {}, "height of 0.02 m: must be higher than depth_of_cut = 0.026"),
    (1, CUBE[1], dict(outline="my_tooth.csv"), "must be left out with outline = my_tooth.csv"),
    (1, CUBE[1], dict(heat="true"), "must be left out with heat = true: heat is for a tool with an outline")]
"""Scale and facets of an STL file, values beside it, what is said."""


def test_an_stl_file_that_cannot_be_the_tool_is_refused_in_a_line(tmp_path):
    cases = []
    for number, (scale, facets, values, _) in enumerate(FILES):
        file = tmp_path / f"tool{number}.stl"
        cases.append(arguments({**OF_A_FILE, "stl": file, **values, "out": tmp_path / "out"}))
        if scale:
            # A second, smaller cube in front of it, for those facets that take it.
            write_stl(file, scale * np.vstack([CUBE[0], 0.2 * CUBE[0] + [0.06, 0, 0]]), facets)
    found = refusals(ROOT / "yade_scripts/cutting_3d_triangles.py", tmp_path, cases)
    for number, ((code, said), (*_, words)) in enumerate(zip(found, FILES, strict=True)):
        assert_refused(code, said, f"error: stl = {tmp_path}/tool{number}.stl")
        assert_refused(code, said, words)
    run = run_script(ROOT / "yade_scripts/cutting_3d_triangles.py", *cases[2])
    assert_refused(run.code, run.stderr, FILES[2][3])
    assert not (tmp_path / "out").exists()

"""One bond between two particles: YADE's forces are those of the bond law, on every path that could be thought of."""

import pytest

from tests.running import ROOT, assert_refused, checks_of, run_script

SCRIPT = ROOT / "yade_scripts/two_disc.py"


@pytest.fixture(scope="module")
def checks(tmp_path_factory):
    """All checks, made in one process of YADE."""
    return checks_of("two_disc_checks", tmp_path_factory.mktemp("two_disc"))


def test_programme_of_the_monograph_for_every_law(checks):
    assert len(checks["programme"]) == 9
    for kinds in checks["programme"].values():
        assert len(kinds) == 6 and max(kinds.values()) < 1e-12


def test_random_paths_in_the_plane(checks):
    assert max(checks["plane"].values()) < 1e-12


def test_random_paths_in_space_with_shear_in_two_directions(checks):
    assert max(checks["space"].values()) < 3e-6
    # Here nothing is found again from normals.
    assert checks["space"]["cohesive"] < 1e-13 and checks["space"]["crushing"] < 1e-13


def test_the_order_of_the_ids_changes_nothing(checks):
    assert max(checks["swapping"].values()) < 1e-13


def test_forces_turn_with_the_pair(checks):
    """What a radian of rotation changes is YADE's own error, of the first order in the step."""
    for law, difference in checks["shear_rotation"].items():
        assert difference < 3e-3 and difference < 0.6 * checks["turning in half the steps"][law]


def test_after_breakage_yade_alone_gives_a_coulomb_contact(checks):
    for found in checks["coulomb"].values():
        assert found["softening_bonds"] == 0 and found["slides"] > 100 and found["deviation"] < 1e-12


def test_work_until_a_bond_is_gone_is_that_of_the_triangle(checks):
    for name in ("damage", "elasto-plastic"):
        found = checks["work"][name]
        assert abs(found["tension"]) < 1e-6 and abs(found["shear"]) < 1e-6
        assert found["modes"] == [1, 2] and found["missing"] == 0


def test_looks_seven_steps_apart_see_the_whole_fracture_energy(checks):
    found = checks["work"]["cohesive"]
    assert abs(found["tension"]) < 1e-12 and found["mode"] == 1 and found["missing"] == 0


def test_looks_turn_the_slip_of_a_pair_that_rotates(checks):
    """YADE turns a bond with its contact, but not what of it has slipped."""
    found, missed = checks["looks"], checks["without realigning"]
    assert missed > 0.02
    for period, error in (("1", 3e-4), ("10", 2e-3), ("40", 8e-3)):
        assert found[period]["force"] < error < 0.2 * missed and abs(found[period]["energy"]) < 1e-3


def test_a_bond_that_slid_without_shear_strength_has_none_stored_when_it_closes(checks):
    """YADE's own step takes less slip than there was, and nothing where the force is 0."""
    assert checks["closed again"]["1"] < 1e-12 and checks["closed again"]["10"] < 1e-3


def test_a_weak_bond_that_slid_has_no_more_stored_than_it_bears_when_it_closes(checks):
    """Of what a bond slips in a step YADE takes the part that its limit is of the trial force: where looks alone took
    out the rest, it pushed with nine tenths of its strength."""
    assert checks["weak, closed again"]["1"] < 1e-3 and checks["weak, closed again"]["10"] < 5e-3


def test_slip_damages_as_the_law_says_late_by_a_look(checks):
    """Errors of the first order in the time between looks."""
    found = checks["damaged by slip"]
    for case, error in (("1000 steps, 1", 1e-2), ("4000 steps, 1", 2.5e-3), ("4000 steps, 10", 2.5e-2)):
        assert found[case]["force"] < error and abs(found[case]["energy"]) < error
        # Broken, and still a contact with friction.
        assert found[case]["mode"] == 2 and found[case]["status"] == 1 and found[case]["presses"]
    assert found["4000 steps, 1"]["force"] < 0.3 * found["1000 steps, 1"]["force"]


def test_opening_and_slip_take_the_same_strength(checks):
    """What is left to slip after half of the opening is far more than what is left of the stiffness, a quarter."""
    found = checks["damaged both ways"]
    for case, error in (("1000 steps, 1", 1e-3), ("4000 steps, 1", 2.5e-4), ("4000 steps, 10", 2e-3)):
        assert found[case]["force"] < error and abs(found[case]["energy"]) < 2e-2 and found[case]["status"] == 1
        assert found[case]["by slip"] == pytest.approx(0.382, abs=5e-3) and not found[case]["presses"]
    assert found["4000 steps, 1"]["force"] < 0.3 * found["1000 steps, 1"]["force"]


def test_crushing_takes_its_work_and_leaves_a_contact(checks):
    """Crushed, pulled apart to the end while still nearer than it was, crushed again while it slides."""
    for period, error in (("1", 1e-3), ("10", 3e-3)):
        found = checks["crushed"][period]
        assert found["force"] < 0.1 * error and abs(found["energy"]) < error and abs(found["crushed"]) < 2e-3
        assert found["cracks"] == 1 and found["status"] == 1


def test_crushing_hardens_late_by_a_look(checks):
    """Errors of the first order in the time between looks; harder, the pair is shortened too little to break."""
    found = checks["hardening"]
    for case, error in (("1000 steps, 1", 1e-2), ("4000 steps, 1", 2.5e-3), ("4000 steps, 10", 2.5e-2)):
        assert found[case]["force"] < 0.2 * error and abs(found[case]["energy"]) < error
        assert abs(found[case]["crushed"]) < error and found[case]["cracks"] == 0
    assert found["4000 steps, 1"]["force"] < 0.3 * found["1000 steps, 1"]["force"]


def test_the_work_of_slip_goes_to_the_two_particles_in_halves(checks):
    found = checks["slip by particle"]
    assert found["halves"] == pytest.approx([0.5, 0.5], rel=1e-12) and found["left"] == 0
    assert found["work"] == pytest.approx(found["exact"], rel=1e-4)


def test_energy_of_a_free_pair_that_flies_apart(checks):
    for found in checks["flying"].values():
        assert found["broken"] == 1
        assert found["residual"] < 1e-3
    # Whichever step of the motion a look comes at.
    for name in ("flying, looked at every ten steps", "flying, damaged by slip"):
        assert all(found["broken"] == 1 and found["residual"] < 4e-3 for found in checks[name])
        assert min(found["residual"] for found in checks[name]) < 1e-3


def test_the_work_of_slip_of_a_bond_that_is_wide_open(checks):
    """YADE's increment of shear is smaller than the way over which the force works: by the radii over the distance."""
    for period, error in (("1", 1e-4), ("10", 1e-2)):
        found = checks["wide open"][period]
        assert found["status"] == 1 and abs(found["residual"]) < error < 0.1 < found["by increments"]


def test_a_stronger_bond_is_the_same_bond_larger(checks):
    assert max(checks["scaled"].values()) < 1e-12


def test_a_resumed_bond_is_equal_bit_for_bit(checks):
    for found in checks["resuming"].values():
        assert found["difference"] == 0 and found["largest"] > 1e4
    assert 0.1 < checks["resuming"]["cohesive"]["softened"]
    assert 0.1 < checks["resuming"]["damaged by slip"]["softened"] < 1
    assert checks["resuming"]["crushing"]["softened"] == 1


def test_an_engine_broken_on_purpose_is_noticed(checks):
    assert len(checks["broken on purpose"]) == 4
    assert min(checks["broken on purpose"].values()) > 0.01


def test_the_scene_leaves_a_figure_for_each_of_the_monograph(tmp_path):
    run = run_script(SCRIPT, "--out", str(tmp_path / "out"), "--steps", "101", out=tmp_path / "out")
    assert run.code == 0, run.stderr
    figures = {file.stem for file in (tmp_path / "out/figures").glob("*.png")}
    assert figures >= {f"figure_4_{number}" for number in range(11, 27)} and len(figures) == 48
    assert (tmp_path / "out/report.html").stat().st_size > 1e5
    results = {name: entry["value"] for name, entry in run.summary["results"].items()}
    assert results["largest deviation"] < 1e-12
    assert results["plastic, shear with tension: largest resultant"] == pytest.approx(1e5, rel=0.02)
    assert results["plastic, shear with tension: largest Ft"] < 0.91e5
    assert results["damage, shear with tension: largest Ft"] == pytest.approx(1e5, rel=0.02)
    assert results["damage, shear with tension: largest Fn"] < 0.51e5


@pytest.mark.parametrize("words, error", [
    (("--kn", "-1"), "kn = -1 N/m: must be greater than 0"),
    (("--kt", "1"), "radius = 0.00125 m: must be more than 1.25e+05, where the paths end"),
    (("--H", "1e7"), "H = 1e+07 N/m: must be more than 1.01e+08, so that the paths end before the radius, 0.00125 m")])
def test_the_scene_refuses_what_it_cannot_use(tmp_path, words, error):
    run = run_script(SCRIPT, *words, "--out", str(tmp_path / "out"))
    assert_refused(run.code, run.stderr, error)
    assert not (tmp_path / "out").exists()


def test_the_scene_replaces_no_file_of_another_origin(tmp_path):
    (tmp_path / "summary.json").write_text("mine", encoding="utf-8")
    run = run_script(SCRIPT, "--out", str(tmp_path))
    assert_refused(run.code, run.stderr, "a folder of runs: summary.json there would be replaced")
    assert [file.name for file in tmp_path.iterdir()] == ["summary.json"]


def test_a_difference_from_the_laws_is_an_error_in_the_summary_too(tmp_path):
    """Paths so long that YADE's sums of 1e-11 m count for nothing."""
    run = run_script(SCRIPT, "--radius", "1e6", "--kn", "1", "--kt", "1e15", "--H", "1", "--steps", "11", "--out",
                     str(tmp_path / "out"), out=tmp_path / "out")
    assert run.code == run.summary["exit_code"] == 1
    assert run.summary["ended"].startswith("YADE and the bond laws differ by ") and run.summary["ended"] in run.stderr

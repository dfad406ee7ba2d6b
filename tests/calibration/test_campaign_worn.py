"""make campaign-worn in miniature: a tool wears, its outlines cut fresh rock, runs and tables are kept."""
import csv
import json

import numpy as np
import pytest

from calibration.campaigns import sharp_and_worn
from calibration.campaigns.runs import finished
from rockwear.kernels.polygon import area
from rockwear.kernels.steady_record import Measured
from rockwear.report.folder import RunFolder
from tests.running import packing

TINY = {**sharp_and_worn.CUT, "discs_per_depth": 4, "cut_length": 0.02, "snapshot_period": 5e-4}
SEEDS = 2, 3


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    """-> (folder of the finished campaign, a function that runs it again)."""
    folder = tmp_path_factory.mktemp("campaign")

    def run():
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(sharp_and_worn, "SHAPES", 2)
            patch.setattr(sharp_and_worn, "SEEDS", SEEDS)
            patch.setattr(sharp_and_worn, "CUT", TINY)
            patch.setattr(sharp_and_worn, "WORN", {
                **TINY, "rake": sharp_and_worn.RAKE, "seed": packing(1, 4), "wear_acceleration": 2.2e3})
            assert sharp_and_worn.main(folder) == 0
    run()
    return folder, run


def test_worn_shapes_cut_fresh_rock(campaign):
    folder = campaign[0]
    with open(folder / "sharp_and_worn.csv", encoding="utf-8") as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    assert len(rows) == 2 * len(SEEDS) and all(row["force"] > 0 for row in rows)
    new, worn = (np.loadtxt(folder / f"outlines/tool_{n}.csv", delimiter=",", skiprows=1) for n in (0, 1))
    assert new[:, 1].min() == 0 == worn[:, 1].min()
    lost = max(row["lost [m2]"] for row in rows)
    assert 0.02 * area(new) < lost and area(worn) == pytest.approx(area(new) - lost, rel=0.02)
    for seed in SEEDS:
        cuts = [RunFolder(folder / f"tool_{n}-{seed}") for n in (0, 1)]
        assert np.array_equal(*(cut.model["rock_radii"] for cut in cuts))
        assert all(cut.result("worn_volume") < 0.01 * lost for cut in cuts)
    text = (folder / "sharp_and_worn.md").read_text(encoding="utf-8")
    # New and worn, and how they differ.
    assert text.count("mm² |") == 3 and (folder / "sharp_and_worn.png").exists()


def test_finished_runs_stay_and_another_shape_is_cut_again(campaign):
    folder, run = campaign
    written = {path: path.stat().st_mtime_ns for path in folder.glob("**/summary.json")}
    assert len(written) == 1 + 2 * len(SEEDS)
    run()
    assert {path: path.stat().st_mtime_ns for path in folder.glob("**/summary.json")} == written
    outline, cut = folder / "outlines/tool_1.csv", folder / f"tool_1-{SEEDS[0]}"
    assert finished(cut, {"outline": outline})
    outline.write_text(outline.read_text(encoding="utf-8").replace("\n", "\n ", 2), encoding="utf-8")
    assert not finished(cut, {"outline": outline})


@pytest.mark.parametrize("summary", [None, {"exit_code": 1}])
def test_without_the_run_that_wears_nothing_is_written(tmp_path, capsys, summary):
    if summary:
        (tmp_path / "worn").mkdir()
        (tmp_path / "worn/summary.json").write_text(json.dumps(summary), encoding="utf-8")
    assert sharp_and_worn.main(tmp_path, read=True) == 2
    said = capsys.readouterr()
    assert said.err == f'error: DIR = {tmp_path}: must be a folder with the finished run "worn"\n' and not said.out
    assert [path.name for path in tmp_path.iterdir()] == (["worn"] if summary else [])


def test_differences_are_taken_in_the_same_packing():
    def tool(lost, forces):
        return {"lost": lost, "each": {seed: {name: Measured(force, 9.0) for name in sharp_and_worn.QUANTITIES}
                                       for seed, force in forces.items()}}
    new, worn = tool(0.0, {1: 30.0, 2: 50.0, 3: 90.0}), tool(1e-6, {1: 41.0, 2: 60.0, 3: 99.0, 5: 7.0})
    (lost, *found), = sharp_and_worn.differences([new, worn])
    assert lost == "1.00 mm²" and found == ["10 ± 0.58"] * len(sharp_and_worn.QUANTITIES)


@pytest.mark.parametrize("rake", [-30, 0, 20])
def test_the_rake_of_a_straight_front_is_its_own(rake):
    slope = np.tan(np.radians(rake))
    tool = np.array([[0.0, 0.0], [-0.03 * slope, 0.03], [-0.05, 0.03], [-0.05, 0.01]])
    assert np.degrees(sharp_and_worn.effective_rake(tool, 0.015)) == pytest.approx(rake)


def test_the_theory_takes_the_strength_of_the_rock():
    sharp, blunt = (sharp_and_worn.evans(np.radians(rake), 5e-3) for rake in (0, -20))
    # 2 σt d sin(45°) / (1 - sin(45°)), 3.835 MPa in tension, as measured on five packings.
    assert sharp == pytest.approx(2 * 3.835e3 * 5e-3 * np.sin(np.pi / 4) / (1 - np.sin(np.pi / 4)), rel=1e-3)
    assert blunt > sharp

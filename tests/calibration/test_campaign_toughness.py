"""The campaign on toughness and size: similar specimens, and what its page tells of them."""
import json
import math

import pytest

from calibration.campaigns import toughness_size as campaign

ROCK, LEAST_SIZE = "cohesive", 16
"""The test takes no specimen below so many largest radii."""


def made_up(folder, K, W_0):
    """Summaries of specimens whose K at the peak force follows the law of size."""
    for (_, size, seed), (name, _) in campaign.plan([ROCK]).items():
        results = {"fracture_toughness": 1e5 * (9 + seed), "fracture_energy": 40.0 + seed,
                   "peak_toughness": K / math.sqrt(1 + W_0 / size)}
        (folder / name).mkdir()
        (folder / name / "summary.json").write_text(json.dumps({
            "results": {name: {"value": value, "unit": "-"} for name, value in results.items()}, "parameters": {}}),
            encoding="utf-8")


def test_specimens_are_similar_and_large_enough():
    for rock, values in campaign.ROCKS.items():
        sizes = campaign.sizes(rock)
        assert sizes[0] >= LEAST_SIZE * values["radius_max"]
        assert sizes[2] / sizes[0] == pytest.approx(4, rel=0.02)
    assert len({name for name, _ in campaign.plan(campaign.ROCKS).values()}) == len(campaign.plan(campaign.ROCKS))


def test_the_page_has_each_size_and_what_they_go_to(tmp_path):
    made_up(tmp_path, 9e5, 0.03)
    assert campaign.main(tmp_path, ["--read"]) == 0
    page = (tmp_path / "toughness_size.md").read_text(encoding="utf-8")
    assert "Without end 0.9 MPa√m at the peak force, W_0 = 30 mm." in page and "grains" not in page
    assert "| 40.5 | 3 | 1.1 ± 0.058 | 42 ± 0.58 | 0.682 ± 0 |" in page
    assert (tmp_path / "toughness_size.png").stat().st_size > 1e4

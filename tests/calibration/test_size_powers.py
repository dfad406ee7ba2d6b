"""Powers that keep a rock's strengths over the radius, on a made-up laboratory."""
import json

import numpy as np
import pytest

from calibration.fitting import size_powers
from calibration.fitting.size_powers import POWERS, SizedLaboratory
from rockwear.model import rock_file
from rockwear.scenes.parameters import OF_ROCK

ANSWERS = np.array([[0.05, 0.7], [0.8, 0.15]])
"""(2, 2): change of ln UCS and ln tensile strength with ln bond_tension and ln bond_cohesion; not the first guess."""
LOST = np.array([-0.16, -0.06])
"""Powers of the radius with which the strengths of the made-up rock grow without any."""
STRENGTHS = 50e6, 4e6


def made_up(powers, ratios, seeds):
    """What a laboratory measures: packings have factors of their own, a few per cent, the same at every radius."""
    found = {}
    for test, strength, answers, lost in zip(size_powers.TESTS, STRENGTHS, ANSWERS, LOST):
        own = np.array([1 + 0.05 * np.random.default_rng([seed, len(test)]).normal() for seed in seeds])
        for ratio in ratios:
            found[test, ratio] = strength * own * ratio**(lost + answers @ powers)
    return found


def test_exponents_of_power_laws_are_exact():
    powers = np.array([-0.2, 0.3])
    mean, error = size_powers.exponents(made_up(powers, (3.0, 1 / 3.0), (1, 2, 3)), 3.0)
    assert mean == pytest.approx(LOST + ANSWERS @ powers, abs=1e-12) and error == pytest.approx(0.0, abs=1e-12)


def test_powers_are_found_with_which_no_strength_changes():
    solution = size_powers.search(
        lambda powers: size_powers.exponents(made_up(powers, (4.0, 0.25), (1, 2, 3)), 4.0), factor=4.0, start=(0, 0))
    assert solution.reached and len(solution.steps) <= size_powers.SEARCHES
    assert abs(LOST + ANSWERS @ solution.x).max() < 0.02


def test_packings_that_failed_do_not_count():
    """The exponents and changes are those of the packings that ended well."""
    ratios = 3.0, 1.0, 1 / 3.0
    found, kept = (made_up(np.zeros(2), ratios, seeds) for seeds in ((1, 2, 3), (1, 3)))
    for ratio in ratios:
        found["compression", ratio][1] = np.nan
    assert size_powers.exponents(found, 3.0)[0] == pytest.approx(LOST, abs=1e-12)
    left, right = (size_powers.changes(of, 3.0)[:3] for of in (found, kept))
    assert [row[2:6] for row in left] == [pytest.approx(row[2:6]) for row in right]


def test_what_packings_do_not_tell_is_not_said_to_stay():
    """Both means are the file's; one of the two changes is known, the other is not."""
    test, (_, _, allowed) = next(iter(size_powers.TESTS.items()))
    found = made_up(np.zeros(2), (3.0, 1.0, 1 / 3.0), (1, 2, 3, 4))
    for ratio, spread in ((3.0, 0.5), (1 / 3.0, 5.0)):
        found[test, ratio] = found[test, 1.0] * (1 + spread * allowed * np.array([-1, 1, -1, 1]))
    assert [row[-1] for row in size_powers.changes(found, 3.0)[:3]] == [True, True, False]


@pytest.fixture
def run(tmp_path, monkeypatch, capsys):
    """run(word, ...) -> (exit code, stdout, stderr) of the command with the made-up laboratory."""
    monkeypatch.setattr(SizedLaboratory, "measure", lambda self, powers, ratios, seeds: made_up(powers, ratios, seeds))

    def of(*words):
        return size_powers.main([*map(str, words), "--out", str(tmp_path / "out")]), *capsys.readouterr()
    return of


def test_the_rock_with_its_powers_can_be_read_and_the_page_says_how_far_it_stays(run, tmp_path):
    code, said, wrong = run("--rock", "medium_sandstone")
    assert code == 0 and not wrong and said.endswith("out/rock.json\n")
    before, after = (rock_file.read(path, OF_ROCK).parts["plane"] for path in
                     (rock_file.find("medium_sandstone"), tmp_path / "out" / "rock.json"))
    found = np.array([after.parameters[power] for power in POWERS])
    assert np.all(abs(LOST + ANSWERS @ found) * np.log(2) < 0.5 * np.array([0.05, 0.10]))
    assert before.parameters == {name: value for name, value in after.parameters.items() if name not in POWERS}
    page = (tmp_path / "out" / "size_powers.md").read_text(encoding="utf-8")
    assert "the strengths of the rock stay" in page and page.count("| yes |") == 6 and "| **no** |" not in page


def test_strengths_that_no_powers_keep_are_said(run, monkeypatch, tmp_path):
    """At both ends the rock is weaker: one power cannot mend it."""
    def bent(self, powers, ratios, seeds):
        return {(test, ratio): values * (1.0 if ratio == 1 else 0.8)
                for (test, ratio), values in made_up(powers, ratios, seeds).items()}
    monkeypatch.setattr(SizedLaboratory, "measure", bent)
    code, _, wrong = run("--rock", "medium_sandstone")
    page = (tmp_path / "out" / "size_powers.md").read_text(encoding="utf-8")
    assert code == 3 and not wrong and "**do not all stay**" in page and page.count("| **no** |") == 4


@pytest.mark.parametrize("packings", [5, 25])
def test_the_check_is_of_packings_that_the_search_has_not_seen(run, monkeypatch, packings):
    seen = {}

    def noted(self, powers, ratios, seeds):
        seen.setdefault(len(ratios), set()).update(seeds)
        return made_up(powers, ratios, seeds)
    monkeypatch.setattr(SizedLaboratory, "measure", noted)
    run("--rock", "medium_sandstone", "--packings", packings)
    assert len(seen[2]) == len(seen[3]) == packings and not seen[2] & seen[3]


@pytest.mark.parametrize("words, said", [
    ((), "rock = nothing"), (("--rock", "m_sandstone"), "rock = m_sandstone, bond_law = brittle"),
    (("--rock", "no_such"), "rock = no_such"), (("--rock", "medium_sandstone", "--factor", "1"), "factor = 1"),
    (("--rock", "medium_sandstone", "--packings", "1"), "packings = 1"),
    (("--rock", "medium_sandstone", "--packings", "1e9"), "packings = 1e9: must be a whole number of at most 100"),
    (("--rock", "medium_sandstone", "--jobs", "1000000"), "jobs = 1000000: must be at most ")])
def test_what_cannot_be_used_is_refused_in_one_line(run, tmp_path, words, said):
    code, shown, wrong = run(*words)
    assert code == 2 and not shown and wrong.startswith(f"error: {said}") and wrong.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_byte_order_mark_is_none_of_the_rock(tmp_path):
    text = rock_file.find("medium_sandstone").read_text(encoding="utf-8")
    (tmp_path / "rock.json").write_text(text, encoding="utf-8-sig")
    assert size_powers.rock_of({"rock": str(tmp_path / "rock.json")}) == json.loads(text)


def test_runs_are_of_the_same_packing_at_every_radius(tmp_path):
    started = {}

    class Kept:
        def start(self, name, script, **values):
            started[name.partition("/")[2]] = values

    data = json.loads(rock_file.find("medium_sandstone").read_text(encoding="utf-8"))
    laboratory = SizedLaboratory(runs=Kept(), data=data, folder=tmp_path)
    for ratio in (4.0, 1.0):
        laboratory._start("tension", ratio, 7, "rock", tmp_path / "rock.json")
    coarse, own = started["tension-4-7"], started["tension-1-7"]
    assert own["radius_min"] == data["plane"]["resolution"]["radius_min"] and own["seed"] == 7
    assert all(coarse[name] == 4 * own[name] for name in ("width", "height", "radius_min", "radius_max"))

"""The record of what a moving window leaves behind: each chip once and whole, the groove where it is."""
import numpy as np
import pytest

from rockwear.model.rock_mass import RockMass
from rockwear.scenes.cut_record import CHIPS, GROOVE, CutRecord

DEPTH, START = 5e-3, 8e-3


@pytest.fixture
def rock():
    return RockMass(seed=2, width=0.06, height=0.03, radius_min=0.8e-3, radius_max=1.2e-3, porosity=0.12,
                    bonding_gap=1e-4, density=2300.0)


def cut_through(rock, chip):
    """(intact (m,), record): all rock above the path is gone but for a chip, (n,) bool, of one piece."""
    path = rock.height - DEPTH
    above = rock.positions[:, 1] > path
    rock.leave_out(above & ~chip)
    i, j = rock.pairs.T
    intact = rock.bonded & (chip[i] == chip[j])
    return intact, CutRecord(rock=rock, start=(START, path))


def chip_of(rock):
    """A piece of rock over the border of two slabs."""
    x, y = rock.positions.T
    border = 3 * rock.slab_length
    return (abs(x - border) < 4e-3) & (y > rock.height - DEPTH)


def drive(rock, intact, record, slabs):
    for k in range(slabs):
        record.note(positions=rock.places, intact=intact & rock.bonded, distance=(k + 1) * rock.slab_length)
        rock.advance()


def test_a_chip_counts_once_and_whole_though_its_slabs_leave_one_after_the_other(rock):
    chip = chip_of(rock)
    members, area = int(chip.sum()), float(np.pi * np.sum(rock.radii[chip]**2))
    intact, record = cut_through(rock, chip)
    drive(rock, intact, record, 6)
    rows = [dict(zip(CHIPS, row)) for row in record.chips if row[CHIPS.index("particles")] > 3]
    assert len(rows) == 1
    assert rows[0]["particles"] == members and rows[0]["area"] == pytest.approx(area)
    first = int(rock.positions[chip, 0].min() / rock.slab_length)
    assert rows[0]["distance"] == pytest.approx((first + 1) * rock.slab_length) and 0 < rows[0]["y"] < DEPTH


def test_the_groove_is_the_top_of_the_rock_that_is_left(rock):
    intact, record = cut_through(rock, np.zeros(rock.count, bool))
    drive(rock, intact, record, 8)
    x, height = np.array(record.groove).T
    assert len(GROOVE) == 2 and (np.diff(x) > 0).all() and x[0] > 0
    assert x[-1] == pytest.approx(8 * rock.slab_length - START, abs=rock.slab_length)
    # Centres up to the path are left: the top lies within a radius above it and a diameter below.
    assert np.nanmax(height) <= rock.radii.max() + 1e-12 and np.nanmin(height) > -2.4e-3


def test_what_still_lies_in_the_window_counts_at_the_end_without_changing_the_record(rock):
    chip = chip_of(rock)
    intact, record = cut_through(rock, chip)
    groove, chips = record.whole(positions=rock.places, intact=intact, distance=0.03, behind=0.03)
    assert record.groove == [] and record.chips == []
    assert max(row[CHIPS.index("particles")] for row in chips) == chip.sum()
    assert groove[-1][0] == pytest.approx(0.03 - START, abs=2 * rock.slab_length)


@pytest.mark.parametrize("slabs", [0, 3])
def test_a_free_chip_that_is_removed_counts_once_also_where_its_first_slab_has_left(rock, slabs):
    chip = chip_of(rock)
    intact, record = cut_through(rock, chip)
    drive(rock, intact, record, slabs)
    # Rock that has entered is no part of it.
    rock.absent[rock.laps > 0] = True
    assert (record.noted & chip).any() == (slabs > 0)
    touched = np.flatnonzero(chip & ~rock.absent)[:1]
    there = dict(positions=rock.places, intact=intact & rock.bonded, distance=0.03, pairs=rock.pairs[:0])
    assert not np.isin(touched, record.record_free_chips(**there, held=touched)).any()
    gone = record.record_free_chips(**there, held=touched[:0])
    assert np.isin(touched, gone).all() and not record.noted[gone].any()
    rock.absent[gone] = True
    drive(rock, intact, record, 6)
    rows = [row for row in record.chips if row[CHIPS.index("particles")] > 3]
    assert len(rows) == 1 and rows[0][CHIPS.index("particles")] == chip.sum()


def test_a_restart_knows_what_was_noted(rock):
    chip = chip_of(rock)
    intact, record = cut_through(rock, chip)
    drive(rock, intact, record, 3)
    again = CutRecord(rock=rock, start=(START, rock.height - DEPTH))
    again.restore(record.state())
    assert again.chips == record.chips and again.groove == record.groove
    assert (again.noted == record.noted).all() and record.noted.any()

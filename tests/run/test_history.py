"""Rows on the disk as they come: exact and as text, cut back to a checkpoint, and a disk that is full."""
import errno
import gc
import subprocess
import sys
import tracemalloc

import numpy as np
import pytest

from rockwear.engines.history import History, write_table
from rockwear.kernels import files
from rockwear.kernels.files import replacing, write_arrays
from tests.running import ROOT

HEADER = ["time [s]", "force [N/m]"]
ROWS = [[k / 7, -1e3 * k**0.5] for k in range(10_000)]


def filled(folder, rows=ROWS):
    history = History()
    history.append(HEADER, rows[0])
    assert history.open(folder / "rows.f8", folder / "rows.csv")
    for row in rows[1:]:
        history.append(HEADER, row)
    return history


def test_rows_are_on_the_disk_at_once_and_exact(tmp_path):
    history = filled(tmp_path)
    write_table(tmp_path / "table.csv", HEADER, ROWS)
    assert (tmp_path / "rows.csv").read_bytes() == (tmp_path / "table.csv").read_bytes()
    assert np.array_equal(history.rows, ROWS) and np.array_equal(np.fromfile(tmp_path / "rows.f8"), np.ravel(ROWS))
    history.append(HEADER, [1.0, np.nan])
    assert history.rows[-1, 0] == 1.0 and (tmp_path / "rows.csv").read_bytes().endswith(b"\n1,nan\n")


def test_a_table_takes_no_memory_for_its_whole_text(tmp_path):
    tracemalloc.start()
    write_table(tmp_path / "table.csv", HEADER, iter(ROWS))
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 0.5 * (tmp_path / "table.csv").stat().st_size


@pytest.mark.parametrize("left", [5000, 1, 0])
def test_a_resumed_history_neither_loses_nor_doubles_a_row(tmp_path, left):
    state = {"header": np.array(HEADER if left else [], str), "rows": left}
    filled(tmp_path, ROWS[:left + 77])
    # A line that was cut short as the process was killed.
    with open(tmp_path / "rows.csv", "ab") as file:
        file.write(b"0.12")
    again = History()
    again.restore(state)
    assert again.open(tmp_path / "rows.f8", tmp_path / "rows.csv") and len(again.rows) == left
    for row in ROWS[left:]:
        again.append(HEADER, row)
    write_table(tmp_path / "table.csv", HEADER, ROWS)
    assert np.array_equal(again.rows, ROWS)
    assert (tmp_path / "rows.csv").read_bytes() == (tmp_path / "table.csv").read_bytes()


def test_a_history_that_lacks_rows_is_refused(tmp_path):
    state = filled(tmp_path, ROWS[:100]).state()
    (tmp_path / "rows.f8").write_bytes((tmp_path / "rows.f8").read_bytes()[:-8])
    again = History()
    again.restore(state)
    assert not again.open(tmp_path / "rows.f8", tmp_path / "rows.csv")


def test_memory_does_not_grow_with_the_rows(tmp_path):
    """Resident memory (kB) of a process after 2,000 and 22,000 rows of 25 numbers: 4 MB more as 8 bytes each, 17 as
    lists."""
    words = ("import resource, sys, pathlib; from rockwear.engines.history import History; h = History();"
             "folder = pathlib.Path(sys.argv[1]); h.open(folder / 'f8', folder / 'csv')\n"
             "for n in (2000, 20000):\n"
             "    for k in range(n): h.append(['x [-]'] * 25, [k / 3] * 25)\n"
             "    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)")
    done = subprocess.run([sys.executable, "-c", words, str(tmp_path)], cwd=ROOT, capture_output=True,
                          encoding="utf-8")
    few, many = map(int, done.stdout.split())
    assert many - few < 500, done.stderr


def test_a_full_disk_names_the_file(tmp_path):
    history = filled(tmp_path, ROWS[:3])
    history.exact, history.paths = open("/dev/full", "ab"), ("rows.f8", "rows.csv")
    with pytest.raises(OSError, match="No space left on device: 'rows.f8'"):
        history.append(HEADER, ROWS[3])
    (tmp_path / "whole").write_text("old", encoding="utf-8")
    with pytest.raises(OSError, match="No space left on device: '.*whole'"):
        with replacing(tmp_path / "whole") as file:
            file.write(b"new")
            raise OSError(errno.ENOSPC, "No space left on device")
    assert [path.name for path in tmp_path.glob("whole*")] == ["whole"]
    assert (tmp_path / "whole").read_text(encoding="utf-8") == "old"


def test_arrays_on_a_full_disk_leave_nothing_and_say_it_once(tmp_path, monkeypatch):
    """numpy's own writer, given such a file, says it again from where it is deleted."""
    write_arrays(tmp_path / "one.npz", {"a": np.arange(3.0)})
    said = []
    with monkeypatch.context() as full:
        full.setattr(files, "open", lambda *_: open("/dev/full", "wb"), raising=False)
        full.setattr(sys, "unraisablehook", said.append)
        with pytest.raises(OSError, match="No space left on device: '.*one.npz'"):
            write_arrays(tmp_path / "one.npz", {"a": np.random.default_rng(0).random(100_000)})
        gc.collect()
    assert np.load(tmp_path / "one.npz")["a"].tolist() == [0.0, 1.0, 2.0] and not said

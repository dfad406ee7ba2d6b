"""What a run left in its folder, read back: summary, history, model and snapshots."""
import json
import math
from pathlib import Path

import numpy as np

_NOTHING = np.empty(0)


class RunFolder:
    """A run's folder. Only summary.json must be there; whatever else is missing reads as empty.

    summary, parameters, balances: as written; columns: {name: (rows,)} and units: {name: unit} of history.csv; model:
    {name: array}; times, stages: of the snapshots, in order.
    """

    def __init__(self, path):
        self.path = Path(path)
        self.summary = json.loads((self.path / "summary.json").read_text(encoding="utf-8"))
        self.parameters, self.balances = self.summary.get("parameters", {}), self.summary.get("balances", {})
        self.columns, self.units = read_history(self.path / "history.csv")
        self.model = read_arrays(self.path / "model.npz")
        self._find_snapshots()

    def _find_snapshots(self):
        paths = sorted((self.path / "snapshots").glob("*.npz"), key=lambda path: int(path.stem))
        found = [(path, *read_arrays(path, "time", "stage").values()) for path in paths]
        # A run that ends with a stage is shown twice at the same time, after the stage and after the run. What is there
        # at the end of the run counts, for wear comes in between.
        new = [k for k in range(len(found)) if k == 0 or found[k][1] != found[k - 1][1]]
        self._paths = [found[k][0] for k in new[:-1]] + paths[-1:]
        self.times = np.array([found[k][1] for k in new], float)
        self.stages = np.array([found[k][2] for k in new], int)
        self._first = self.snapshot(0) if new else {}

    def has(self, *names):
        """True where the model or the first snapshot has all these arrays, and none of them is empty."""
        return all(self.model.get(name, self._first.get(name, _NOTHING)).size for name in names)

    def snapshot(self, index):
        """{name: array} of one snapshot; -1 is the last."""
        return read_arrays(self._paths[index])

    def result(self, name):
        """Value of a result in SI, nan where the run has none."""
        value = self.summary.get("results", {}).get(name, {}).get("value")
        return math.nan if value is None else value

    def unit(self, name):
        """Unit of a result, nothing where the run has none."""
        return self.summary.get("results", {}).get(name, {}).get("unit", "")

    def parameter(self, name, default=math.nan):
        """Value of a parameter."""
        return self.parameters.get(name, default)

    def table(self, file, *names):
        """Columns of one of the run's tables, empty where it is not there."""
        columns, _ = read_history(self.path / file)
        return [columns.get(name, np.zeros(0)) for name in names]

    def column(self, name):
        """A column of the history, nan where it was not recorded."""
        return self.columns.get(name, np.full(self.rows, np.nan))

    def over_stage(self, name, pick, stage):
        """`pick` (a mean, say) of a column's finite values in one stage, nan without any."""
        values = self.column(name)[self.column("stage") == stage]
        values = values[np.isfinite(values)]
        return float(pick(values)) if len(values) else math.nan

    def mean_over(self, name, rows, seconds=None):
        """Mean of a column over rows (bool), each of which has the mean since the row before; nan without any.
        seconds: over which it is taken, those of the rows by default."""
        rows = rows & np.isfinite(self.column(name))
        elapsed = np.diff(self.column("time"), prepend=0.0)[rows]
        seconds = float(elapsed.sum()) if seconds is None else seconds
        return float(self.column(name)[rows] @ elapsed) / seconds if seconds else math.nan

    @property
    def rows(self):
        """Rows of the history."""
        return len(next(iter(self.columns.values()), ()))

    def stage_ends(self):
        """{stage: index of its last snapshot}, in order."""
        return {int(stage): k for k, stage in enumerate(self.stages)}


def work_entry(balance):
    """Name of the entry of an energy balance that says what work was done on the scene; None without one."""
    return next((name for name in balance if name.endswith("_work")), None)


def read_arrays(path, *names):
    """{name: array} of an npz file, all or those named; empty without the file."""
    if not path.exists():
        return {}
    with np.load(path) as arrays:
        return {name: arrays[name] for name in names or arrays.files}


def read_history(path):
    """({name: column}, {name: unit}) of a file with a header of `name [unit]`; lines cut short are left out."""
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    header = [word.strip() for word in lines[0].split(",") if word.strip()] if lines else []
    names = [word.split(" [")[0] for word in header]
    units = [word.split(" [")[1].rstrip("]") if " [" in word else "-" for word in header]
    rows = [row for row in (line.split(",") for line in lines[1:]) if len(row) == len(header)]
    table = np.array(rows, float).reshape(len(rows), len(header))
    return dict(zip(names, table.T)), dict(zip(names, units))

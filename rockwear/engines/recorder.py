"""Time series of a run."""
import numpy as np

from rockwear.engines.base import Engine


class Recorder(Engine):
    """Rows of named values at a regular interval. `sources`: functions giving {name: (value, unit)}."""

    name = "recorder"

    def __init__(self, sources, *, period=1):
        super().__init__(period=period)
        self.sources = sources
        self.header, self.rows = [], []

    def act(self):
        found = [item for source in self.sources for item in source().items()]
        self.header = [f"{name} [{unit}]" for name, (_, unit) in found]
        self.rows.append([value for _, (value, _) in found])

    def columns(self):
        """{name: (rows,) values}."""
        rows = np.array(self.rows, float).reshape(-1, max(1, len(self.header)))
        return {name.split(" [")[0]: rows[:, i] for i, name in enumerate(self.header)}

    def state(self):
        return {"header": np.array(self.header, str), "rows": np.array(self.rows, float)}

    def restore(self, state):
        self.header, self.rows = [str(name) for name in state["header"]], state["rows"].tolist()

    def write(self, path):
        """history.csv, a row a visit."""
        write_table(path, self.header, self.rows)


def write_table(path, header, rows):
    """A CSV file: a header of `name [unit]`, then rows of numbers; in place at once or not at all."""
    lines = [",".join(header)] + [",".join(f"{value:.10g}" for value in row) for row in rows]
    temporary = path.with_suffix(".new")
    temporary.write_text("\n".join(lines) + "\n", encoding="utf-8")
    temporary.replace(path)

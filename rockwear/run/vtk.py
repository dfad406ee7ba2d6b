"""Particles with their fields as legacy VTK files: a series for ParaView (Glyph: sphere, scale by diameter)."""
import numpy as np


def write(path, points, fields):
    """Write particles at `points` (n, 2 or 3) m with `fields` {name: (n,) numbers} to the file `path`."""
    points = np.asarray(points, float)
    points = np.column_stack([points, np.zeros((len(points), 3 - points.shape[1]))])
    n = len(points)
    lines = ["# vtk DataFile Version 3.0", "rockwear", "ASCII", "DATASET POLYDATA", f"POINTS {n} double",
             *("%.9g %.9g %.9g" % tuple(p) for p in points), f"VERTICES {n} {2 * n}", *(f"1 {i}" for i in range(n)),
             f"POINT_DATA {n}"]
    for name, values in fields.items():
        lines += [f"SCALARS {name} double 1", "LOOKUP_TABLE default", *("%.9g" % v for v in np.asarray(values, float))]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")

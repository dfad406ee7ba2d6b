"""Particles or facets with their fields as VTK files, and as a series over time that ParaView opens (of particles:
Glyph, sphere, by diameter).

A time is a file of PolyData, NAME.NNNN.vtp; NAME.pvd names them all, with their times in s.
"""
import base64
import re

import numpy as np

from rockwear.kernels.files import replacing

HEAD = '<VTKFile type="{}" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n'
ENTRY = '<DataSet timestep="{!r}" part="0" file="{}"/>\n'
FOUND = re.compile(r'<DataSet timestep="(.*?)" part="0" file="(.*?)"/>')
CELLS = {1: "Verts", 2: "Lines", 3: "Polys"}
"""{points of a cell: what PolyData calls it}."""
TYPES = {"f": ("Float64", "<f8"), "i": ("Int64", "<i8")}


def _array(name, values, components=1):
    values = np.asarray(values)
    kind, code = TYPES["f" if values.dtype.kind == "f" else "i"]
    data = np.ascontiguousarray(values, code).tobytes()
    text = base64.b64encode(np.array(len(data), "<u8").tobytes() + data).decode()
    return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="binary">{text}'
            "</DataArray>\n")


def write(folder, name, number, time, points, fields, cells=None):
    """Write particles at `points` (n, 2 or 3) m with `fields` {name: (n,) numbers} as the file `number` of the series
    `name`, which shows them at `time` (s). cells: (m, 2 or 3) numbers of points that are ends of segments or corners of
    triangles; None: points alone."""
    points = np.asarray(points, float)
    points = np.column_stack([points, np.zeros((len(points), 3 - points.shape[1]))])
    cells = np.arange(len(points))[:, None] if cells is None else np.asarray(cells, int)
    count, corners = cells.shape
    kind = CELLS[corners]
    folder.mkdir(parents=True, exist_ok=True)
    file_name = f"{name}.{number:04d}.vtp"
    with replacing(folder / file_name) as file:
        file.write("".join([
            HEAD.format("PolyData"),
            f'<PolyData>\n<Piece NumberOfPoints="{len(points)}" NumberOf{kind}="{count}">\n<Points>\n',
            _array("points", points, 3), f"</Points>\n<{kind}>\n", _array("connectivity", cells.ravel()),
            _array("offsets", corners * np.arange(1, count + 1)), f"</{kind}>\n<PointData>\n",
            *(_array(field, np.asarray(values, float)) for field, values in fields.items()),
            "</PointData>\n</Piece>\n</PolyData>\n</VTKFile>\n"]).encode())
    # Two files of one time, of a stage's end and the run's, would be shown as two parts of it.
    entries = _series(folder / f"{name}.pvd")
    if entries and entries[-1][0] == time:
        entries.pop()
    _write_series(folder / f"{name}.pvd", [*entries, (time, file_name)])


def _series(path):
    """[(s, file)] of a series, empty without one."""
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    return [(float(time), name) for time, name in FOUND.findall(text)]


def _write_series(path, entries):
    with replacing(path) as file:
        file.write("".join([HEAD.format("Collection"), "<Collection>\n", *(ENTRY.format(float(time), name)
                            for time, name in entries), "</Collection>\n</VTKFile>\n"]).encode())


def truncate(folder, count):
    """Remove all files but the first `count` of each series in `folder`."""
    for path in folder.glob("*.vtp"):
        if int(path.name.split(".")[-2]) >= count:
            path.unlink()
    for path in folder.glob("*.pvd"):
        _write_series(path, [entry for entry in _series(path) if (folder / entry[1]).exists()])

"""Folders of made-up runs, whole and odd ones, without YADE."""
import json

import numpy as np

HEADER = ["time [s]", "stage [-]", "cutting_force [N/m]", "thrust_force [N/m]", "tool_work [J/m]",
          "kinetic_energy [J/m]", "tool_friction [J/m]", "bond_breaking [J/m]", "mass_lost [-]", "worn_volume [m3/m]",
          "tensile_cracks [-]", "shear_cracks [-]"]
HOT = ["tool_temperature_max [K]", "rock_temperature_max [K]"]


def lattice(columns, rows, radius):
    """Discs on a square lattice from the origin: positions and radii."""
    x, y = np.meshgrid(np.arange(columns), np.arange(rows))
    return np.column_stack([x.ravel(), y.ravel()]) * 2 * radius + radius, np.full(columns * rows, radius)


def neighbours(positions, radius):
    """Pairs of touching discs."""
    distance = np.linalg.norm(positions[:, None] - positions, axis=2)
    return np.argwhere(np.triu(distance < 2.01 * radius, 1))


def make_run(folder, *, heat=True, snapshots=4, rows=30, broken=3, alive=True, value=1.0):
    """A run of start-up and one cycle in `folder`. value: the cutting force in kN/m, wherever it is written."""
    rock, rock_radii = lattice(10, 10, 1e-3)
    tool, tool_radii = lattice(6, 8, 0.5e-3)
    bonds = neighbours(rock, 1e-3)
    (folder / "snapshots").mkdir(parents=True)
    np.savez(folder / "model.npz", rock_radii=rock_radii, rock_fixed=rock[:, 1] < 2e-3, bonds=bonds,
             tool_radii=tool_radii, tool_positions=tool, tool_volumes=np.full(len(tool), 1e-6),
             outline=np.array([[0, 0], [6e-3, 0], [6e-3, 8e-3], [0, 8e-3]]), box=np.array([0.02, 0.02]))
    for k in range(snapshots):
        status = np.zeros(len(bonds), np.int8)
        status[:k * broken] = 1
        left = np.full(len(tool), alive)
        left[5:5 + k] = False
        temperature = np.linspace(293, 293 + 10 * k, len(rock) + len(tool)) if heat else np.empty(0)
        np.savez(folder / "snapshots" / f"{k:04d}.npz", time=1e-3 * k, stage=k // 2, rock_positions=rock,
                 broken_bonds=np.bincount(bonds[status != 0].ravel(), minlength=len(rock)), status=status,
                 temperature=temperature, tool_offset=np.array([-0.006 + 1e-3 * k, 0.017]), alive=left,
                 worn_depth=np.where(left & (tool[:, 1] < 1e-3), 1e-4 * k, 0.0),
                 surface=np.flatnonzero(tool[:, 1] < 1e-3))
    write_history(folder, HEADER + (HOT if heat else []), rows, value)
    write_summary(folder, heat, value)
    return folder


def write_history(folder, header, rows, value):
    time = np.linspace(0, 4e-3, rows)
    waves = [value * 1e3 * (1.1 + np.sin(1e3 * time + k)) for k in range(len(header) - 2)]
    table = np.column_stack([time, time > 2e-3, *waves])
    lines = [",".join(header)] + [",".join(f"{x:.10g}" for x in row) for row in table]
    (folder / "history.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_summary(folder, heat, value):
    numbers = {"mean_cutting_force": (value * 1e3, "N/m"), "mass_lost": (0.0123456789, "-"), "time_step": (5e-8, "s"),
               "critical_time_step": (1e-7, "s"), "rock_particles": (100, "-"), "tensile_cracks": (3, "-")}
    balances = {"energy": {"unit": "J/m", "tool_work": 200.0 * value, "rock_friction": 150.0, "residual": 50.0},
                "mass": {"unit": "kg/m", "archard": 0.0, "removed": 0.0}}
    if heat:
        numbers["tool_temperature_max"] = (350.0, "K")
        balances["heat"] = {"unit": "J/m", "generated": 400.0, "residual": 4.0}
    (folder / "summary.json").write_text(json.dumps({
        "scene": "test_<tooth>", "ended": "finished", "seed": 1, "versions": {"yade": "2023.02a"},
        "parameters": {"velocity": 4.0, "depth_of_cut": 3e-3, "wear_acceleration": 7000.0, "outline": ""},
        "results": {name: {"value": number, "unit": unit} for name, (number, unit) in numbers.items()},
        "balances": balances,
        "wall_time": {"unit": "s", "total": 83.0, "loop": 80.0, "python_engines": 8.0,
                      "by_engine": {"wear": {"seconds": 8.0, "visits": 12}}},
        "peak_memory": {"value": 3e8, "unit": "bytes"}}), encoding="utf-8")

"""The table of the library's rocks: what was asked for beside what the laboratory measured.

    python3 -m calibration.fitting.library [FILE.md]
"""
import json
import sys
from pathlib import Path

from calibration import generated
from rockwear.model.rock_file import LIBRARY, library

SCALES = {"youngs_modulus": ("E", 1e-9, "GPa"), "poissons_ratio": ("ν", 1, ""), "ucs": ("UCS", 1e-6, "MPa"),
          "tensile_strength": ("σt", 1e-6, "MPa"), "fracture_toughness": ("K_IC", 1e-6, "MPa√m"),
          "fracture_energy": ("G_f", 1, "J/m²"), "friction_angle": ("φ", 1, "°"), "cohesion": ("c", 1e-6, "MPa"),
          "hoek_brown_m": ("m_i", 1, ""), "hoek_brown_sigma_ci": ("σci", 1e-6, "MPa")}


def rows(name, rock):
    """Cells of a rock: a row for each property that is a target or measured in the plane."""
    targets, measured = rock["targets"], rock["plane"]["measured"]
    for prop, (label, scale, unit) in SCALES.items():
        if prop in targets or prop in measured:
            yield [name, f"{label}, {unit}".rstrip(", "), *_cells(targets.get(prop, {}).get("value"),
                                                                  measured.get(prop), scale)]
    points = dict(map(tuple, targets.get("triaxial", {}).get("value", [])))
    found = measured.get("triaxial", {})
    deviations = found.get("standard_deviation", [])
    means = {least: (largest, deviation) for (least, largest), deviation in zip(found.get("mean", []), deviations)}
    for least in sorted({*points, *means}):
        entry = means.get(least)
        one = entry and {"mean": entry[0], "standard_deviation": entry[1], "packings": found["packings"]}
        yield [name, f"σ1 at σ3 = {1e-6 * least:g} MPa, MPa", *_cells(points.get(least), one, 1e-6)]


def _cells(target, measured, scale):
    """Target, measured, difference, packings."""
    wanted = "–" if target is None else f"{target * scale:.3g}"
    if not measured:
        return [wanted, "–", "–", "–"]
    mean, deviation = (scale * measured[name] for name in ("mean", "standard_deviation"))
    off = "–" if not target else f"{100 * (measured['mean'] / target - 1):+.1f} %"
    return [wanted, f"{mean:.3g} ± {deviation:.2g}", off, measured["packings"]]


def table():
    """Lines of Markdown."""
    found = {name: json.loads((LIBRARY / f"{name}.json").read_text(encoding="utf-8")) for name in library()}
    lines = ["# Rocks of the library", "", "Measured: mean ± standard deviation of packings that the fit has not seen.",
             "", *generated.table(["rock", "property", "target", "measured", "off", "packings"],
                                  [row for name, rock in found.items() if "plane" in rock
                                   for row in rows(name, rock)])]
    for name, rock in found.items():
        parameters = ", ".join(f"{key} {value:g}" if isinstance(value, (int, float)) else f"{key} {value}"
                               for key, value in rock.get("plane", {}).get("parameters", {}).items())
        lines += [f"- **{name}**: {rock['source']}. In the plane: {parameters}."]
    return lines


if __name__ == "__main__":
    print(generated.write_page(Path(sys.argv[1] if len(sys.argv) > 1 else "calibration/results/generated/rocks.md"),
                               table()))

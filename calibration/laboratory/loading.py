"""How fast and how far a specimen is loaded, by the strain at which its rock fails: strength / E."""
import numpy as np

from rockwear.model.rock_file import RockPresets

SPEED = {"compression": 13.6, "triaxial": 13.6, "tension": 84.0, "brazilian": 16.9}
"""Speed of a platen, m/s, over strength / E, of the deviatoric strength in a confined test, of the tensile one in a
Brazilian test. They are those of [Rojek 2003]'s bonds at 0.1 m/s, in a Brazilian test at 0.02: a rock that fails at
less strain is loaded as much more slowly. They raise strengths by 1.5 %, half as fast costs twice as much
(calibration/results/generated/loading_speed.md)."""
STRAIN = {"compression": 3.0, "triaxial": 2.0, "tension": 6.0, "brazilian": 42.0}
"""Strain at which a test ends at the latest, over strength / E: a specimen that has not failed there is far too strong,
or flows."""
SCALED = "speed", "strain_max", "record_strain"
"""Parameters that follow the strain."""
ROWS = 200
"""Rows of a history up to a strain of strength / E."""


def loading(test, strain):
    """{parameter: value} of a test, of SPEED, of a rock that fails at this strength / E."""
    found = SPEED[test] * strain, STRAIN[test] * strain, strain / ROWS
    return {name: float(f"{value:.4g}") for name, value in zip(SCALED, found)}


def strength(test, properties, confinement=0.0):
    """Pa, what a test looks for in a rock of {property: value}; None where the rock does not say. confinement: Pa.

    Between the points of its triaxial strengths the deviatoric one is interpolated, beyond them it is the last.
    """
    if test in ("tension", "brazilian"):
        return properties.get("tensile_strength")
    if test == "compression":
        return properties.get("ucs")
    points = dict(properties.get("triaxial", ()))
    if "ucs" in properties:
        points[0.0] = properties["ucs"]
    places = sorted(points)
    return float(np.interp(confinement, places, [points[place] - place for place in places])) if points else None


class LoadedRock(RockPresets):
    """The values that the file of a rock gives a laboratory test: its bonds, and by the strength and E that were
    measured, or are its targets, how it is loaded. test: {name: value} of all parameters -> name of the test, of SPEED.

    strain_max is no less than without a rock. What is given on the command line wins.
    """

    def __init__(self, declared, *, test):
        super().__init__(declared)
        self.test = test

    def defaults(self, value, values):
        """{name: value} at the radii of the scene."""
        rock, kind = self.read(value, values)
        properties = {**rock.targets, **{name: entry["mean"] for name, entry in rock.parts[kind].measured.items()}}
        test, modulus = self.test(values), properties.get("youngs_modulus")
        found = strength(test, properties, values.get("confinement", 0.0))
        if not (found and modulus):
            return super().defaults(value, values)
        by_strain = loading(test, found / modulus)
        return {**super().defaults(value, values), **by_strain,
                "strain_max": max(values["strain_max"], by_strain["strain_max"])}

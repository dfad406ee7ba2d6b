"""What a rock fit varies and what it measures, as data: unknowns of a bond law, observables, first guesses, slopes.

Unknowns are chosen so that scaling laws hold exactly, as long as strains are small and loading is slow: stresses grow
with `kn` alone in E, and with `tension` alone in all strengths, because the others are ratios.

    kn             N/m, normal stiffness                          E
    kt_over_kn     ratio of the stiffnesses                       nu, and E
    tension        Pa, tensile strength of a bond over its area   all strengths
    shear          shear strength of a bond over the tensile one  UCS over tensile strength
    mu             friction                                       strengths under confinement
    length         m, fracture energy kn / tension^2              toughness
    crushing       crushing strength of a bond over the tensile   strengths where the rock is ductile
"""
import math
from dataclasses import dataclass

import numpy as np

from calibration.fitting.relations import BOND_AREA, elastic_guess, stored, strength_guess

SHEAR, RATIO, TENSION, FRICTION = 3.0, 8.1, 1.6, 0.7
"""First guesses in grains: shear over tensile strength of a bond at this UCS over tensile strength, with whose square
it goes, by hand from ratios of 6.2, 8.1, 13.0 that 1.5, 3, 7 gave at an edge of 1.8 radii (rock_targets.GRAINS);
a bond's tensile strength over the rock's, 7 over 4.1 to 4.4 MPa (calibration/results/rock_laws.md). Bare discs have the
stored relations. Friction of both."""
LEAST = 1.01
"""length over the radius, of bonds that are all but brittle."""
STEEPNESS, BEND = 6.9, 1.4
"""First guess of friction from confined strengths: the rise of sigma1 over that of sigma3 up to the highest point, from
the last one of at most half its confinement, at which it is FRICTION, and with which power of the rise it goes. In
grains of 2 radii friction of 0.7, 0.45 and 0.40 gave rises of 6.9, 4.8 and 4.7 between 8 and 30 MPa (two packings)."""
CRUSHING = 1.35
"""First guess: crushing strength of bonds over the highest sigma1 at which the rock is ductile. Bentheim's bonds at 400
MPa gave 1.38 at 150 MPa of confinement, at 250 MPa 1.20 (one packing)."""
TOUGHNESS = 1 / 6.88
"""sqrt(m), K_IC over tensile strength of rocks [Zhang 2002, as recalled], where no toughness is given."""
GAP = 0.08
"""bonding_gap over the mean radius [Rojek 2014, eq. 6], the value of the scenes."""
AIM = 0.4
"""What the fit aims at, as a part of what is allowed."""


@dataclass(frozen=True)
class Observable:
    """One number of the laboratory. test: of rock_tests.TESTS; result: its name there; confinement: Pa; target: SI;
    allowed: relative difference from the target; kind: row of SLOPES."""

    name: str
    test: str
    result: str
    target: float
    allowed: float
    kind: str
    unit: str
    confinement: float = 0.0

    def scaled(self, value):
        """The number that the solver sees: a logarithm, nu itself. nan for what has none."""
        if self.kind == "nu":
            return np.asarray(value, float)
        return np.log(np.where(np.asarray(value, float) > 0, value, math.nan))

    @property
    def tolerance(self):
        """Allowed difference of the scaled number."""
        return max(self.allowed * abs(self.target), 0.005) if self.kind == "nu" else self.allowed


def observables(targets):
    """[Observable] of Targets."""
    t = targets
    found = [Observable("youngs_modulus", "compression", "youngs_modulus", t.youngs_modulus, 0.05, "E", "Pa"),
             Observable("poissons_ratio", "compression", "poissons_ratio", t.poissons_ratio, 0.05, "nu", ""),
             Observable("ucs", "compression", "peak_stress", t.ucs, 0.05, "ucs", "Pa"),
             Observable("tensile_strength", "tension", "peak_stress", t.tensile_strength, 0.1, "tension", "Pa")]
    if t.fracture_toughness is not None:
        found.append(Observable("fracture_toughness", "toughness", "fracture_toughness", t.fracture_toughness, 0.1,
                                "toughness", "Pa sqrt(m)"))
    return found + [Observable(f"sigma1 at {1e-6 * least:.3g} MPa", "triaxial", "peak_stress", largest, allowed, kind,
                               "Pa", confinement=least)
                    for kind, allowed, points in (("confined", 0.05, t.points), ("ductile", 0.1, t.ductile))
                    for least, largest in points]


SLOPES = {
    "E": {"kn": (1, 0), "kt_over_kn": (0.25, 0.1)},
    "nu": {"kt_over_kn": (-0.12, 0.05)},
    "ucs": {"kt_over_kn": (0, 0.2), "tension": (1, 0), "shear": (0.5, 0.3), "mu": (0.3, 0.3), "length": (0.2, 0.2),
            "crushing": (0, 0.1)},
    "tension": {"kt_over_kn": (0, 0.2), "tension": (1, 0), "shear": (0.1, 0.15), "length": (0.15, 0.1)},
    "toughness": {"kt_over_kn": (0, 0.1), "tension": (1, 0), "shear": (0.05, 0.1), "mu": (0, 0.05),
                  "length": (0.5, 0.15)},
    "confined": {"kt_over_kn": (0, 0.2), "tension": (0.6, 0.2), "shear": (0.3, 0.3), "mu": (0.4, 0.3),
                 "length": (0.1, 0.15), "crushing": (0.1, 0.15)},
    "ductile": {"kt_over_kn": (0, 0.2), "tension": (0.5, 0.2), "shear": (0.1, 0.15), "mu": (0.2, 0.2),
                "length": (0, 0.1), "crushing": (0.6, 0.2)}}
"""{kind of observable: {unknown: (slope of its logarithm over that of the unknown, standard deviation)}}; a deviation
of 0: exact. What is not named has no influence."""


class Micro:
    """The unknowns of one fit and what they mean. law: of rock_targets.LAWS; radius: mean radius, m; given: {parameter:
    value} of what is not fitted; 0 is left out; start: {parameter: value} of a rock to begin with."""

    def __init__(self, *, law, targets, radius, given, start=None):
        self.law, self.radius, self.given = law, radius, {name: value for name, value in given.items() if value}
        self.observables = observables(targets)
        guess = {**self._first_guess(targets), **self._of_rock(start)}
        if targets.ductile:
            strength = (start or {}).get("bond_crushing") or CRUSHING * targets.ductile[-1][1]
            guess["crushing"] = strength / guess["tension"]
        spans = {"kn": 10, "kt_over_kn": (0.01, 4.0), "tension": 10, "shear": (0.5, 10.0), "mu": (0.05, 2.0),
                 "length": (radius, 100 * guess["length"]), "crushing": 10}
        bounds = {name: spans[name] if isinstance(spans[name], tuple) else (value / spans[name], value * spans[name])
                  for name, value in guess.items()}
        # Without a target that they decide on, these stay.
        idle = [name for name, target in (("length", targets.fracture_toughness), ("mu", targets.points)) if not target]
        self.fixed = {name: guess.pop(name) for name in idle}
        self.names = list(guess)
        self.first = np.log(list(guess.values()))
        self.low, self.high = np.log([bounds[name] for name in guess]).T

    def _first_guess(self, t):
        kn, ratio = elastic_guess(youngs_modulus=t.youngs_modulus, poissons_ratio=t.poissons_ratio)
        toughness = t.fracture_toughness or TOUGHNESS * t.tensile_strength
        energy = toughness**2 / t.youngs_modulus * kn
        tension, shear = self._strengths(t, ratio, energy)
        length = max(energy / tension**2, LEAST * self.radius)
        friction = FRICTION
        if t.points:
            high, stronger = t.points[-1]
            low, weaker = [point for point in ((0.0, t.ucs), *t.points) if point[0] <= 0.5 * high][-1]
            friction = min(max(FRICTION * ((stronger - weaker) / (high - low) / STEEPNESS)**BEND, 0.1), 1.2)
        return {"kn": kn, "kt_over_kn": ratio, "tension": tension, "shear": shear, "mu": friction, "length": length}

    def _strengths(self, t, ratio, energy):
        """First guess of (tension in Pa, shear) at this kt/kn and kn G_f (Pa² m): with grains by constants, of bare
        discs by the stored relations."""
        if self.given.get("grain_edge"):
            shear = SHEAR * (t.ucs / t.tensile_strength / RATIO)**2
            return TENSION * t.tensile_strength, min(max(shear, 0.7), 8.0)
        data = stored()
        tension, shear = strength_guess(
            data, ucs=t.ucs, tensile_strength=t.tensile_strength, least=LEAST, kt_over_kn=ratio,
            energy=energy / self.radius if self.law == "cohesive" else 0.0,
            porosity=self.given.get("porosity", data["defaults"]["porosity"]))
        return tension * (BOND_AREA if self.law == "brittle" else 1.0), shear

    def _of_rock(self, start):
        """{unknown: value} of the parameters of a rock: the inverse of `parameters`."""
        if not start:
            return {}
        per = 2 * self.radius if self.law == "brittle" else 1.0
        tension, shear = (start[name] / per for name in
                          (("Rn", "Rt") if self.law == "brittle" else ("bond_tension", "bond_cohesion")))
        found = {"kn": start["kn"], "kt_over_kn": start["kt"] / start["kn"], "tension": tension,
                 "shear": shear / tension, "mu": start["mu"]}
        if self.law == "cohesive":
            found["length"] = start["bond_fracture_energy"] * start["kn"] / tension**2
        return found

    def slopes(self):
        """(jacobian (m, n), deviation (m, n)) of the observables over the unknowns."""
        entries = np.array([[SLOPES[o.kind].get(name, (0, 0)) for name in self.names] for o in self.observables], float)
        return entries[..., 0], entries[..., 1]

    def named(self, x):
        """{unknown: value} of logarithms (n,)."""
        return {**dict(zip(self.names, np.exp(x).tolist())), **self.fixed}

    def parameters(self, x):
        """{parameter of a scene: value} of the logarithms (n,) of the unknowns, in five digits."""
        u = self.named(x)
        found = {"kn": u["kn"], "kt": u["kt_over_kn"] * u["kn"]}
        if self.law == "brittle":
            force = 2 * self.radius * u["tension"]
            found.update(Rn=force, Rt=u["shear"] * force)
        else:
            found.update(bond_tension=u["tension"], bond_cohesion=u["shear"] * u["tension"])
        if self.law == "cohesive":
            found["bond_fracture_energy"] = u["length"] * u["tension"]**2 / u["kn"]
        if "crushing" in u:
            found["bond_crushing"] = u["crushing"] * u["tension"]
        found.update(mu=u["mu"], bonding_gap=GAP * self.radius, **self.given)
        return {"bond_law": self.law, **{name: value if isinstance(value, str) else float(f"{value:.5g}")
                                         for name, value in found.items()}}

    def at_bounds(self, x):
        """[words] on the unknowns that ended at a bound."""
        return [f"{name} = {np.exp(value):.3g}" for name, value, low, high in zip(self.names, x, self.low, self.high)
                if min(value - low, high - value) < 1e-6]

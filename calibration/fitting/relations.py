"""Dimensionless relations of a bonded packing [Rojek 2014, 5.2], measured once (calibration.campaigns.rock_laws) and
kept in relations.json, with the scatter of packings; inverted for the first guess of a fit."""
import json
from pathlib import Path

import numpy as np

DATA = Path(__file__).with_name("relations.json")
GAP = 1e-4
"""bonding_gap, m, of the scenes at radii of 1 to 1.5 mm: the relations that count for a first guess."""


def relations(gap=GAP):
    """{name: (k,) or (k, 2) mean and deviation} over kt/kn, rising, at this bonding gap."""
    rows = sorted((row for row in json.loads(DATA.read_text(encoding="utf-8")) if row["bonding_gap"] == gap),
                  key=lambda row: row["kt_over_kn"])
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def elastic_guess(*, youngs_modulus, poissons_ratio):
    """(kn in N/m, kt/kn) for which a packing has this E (Pa) and nu; kt/kn at the end of the data beyond it."""
    found = relations()
    ratios, nu, stiffness = found["kt_over_kn"], found["nu"][:, 0], found["E_over_kn"][:, 0]
    ratio = float(np.interp(-poissons_ratio, -nu, ratios))
    return youngs_modulus / float(np.interp(ratio, ratios, stiffness)), ratio

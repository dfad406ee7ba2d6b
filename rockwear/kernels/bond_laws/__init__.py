"""Force laws of a cohesive bond between two particles [Rojek 2003, ch. 4], one law a file.

A law is a subclass of `base.BondLaw` in a module of this package. It has a `name`, by which the parameter `bond_law`
chooses it, and declares its `parameters`. All modules of the package are imported here, so that a new file is enough:
the law is then in BOND_LAWS, in --help and in every scene.
"""
from importlib import import_module
from pkgutil import iter_modules

from rockwear.kernels.bond_laws.base import BOND_LAWS, Bond, BondLaw, ElasticDomain
from rockwear.kernels.bond_laws.elastic_brittle import ElasticBrittle
from rockwear.kernels.bond_laws.elastic_damage import ElasticDamage
from rockwear.kernels.bond_laws.elasto_plastic import ElastoPlasticSoftening
from rockwear.kernels.bond_laws.hardening import Hyperbolic, Parabolic
from rockwear.kernels.bond_laws.nonlinear_elasto_plastic import NonlinearElastoPlastic

for _module in iter_modules(__path__):
    import_module(f"{__name__}.{_module.name}")

__all__ = ["BOND_LAWS", "Bond", "BondLaw", "ElasticBrittle", "ElasticDamage", "ElasticDomain", "ElastoPlasticSoftening",
           "Hyperbolic", "NonlinearElastoPlastic", "Parabolic"]

LINEAR_LAWS = {name: BOND_LAWS[name] for name in ("brittle", "damage", "plastic")}


def linear_law(name, *, kn, kt, Rn, Rt, H, mu):
    """The law of this name in LINEAR_LAWS: until all callers use from_values."""
    return LINEAR_LAWS[name].from_values(dict(kn=kn, kt=kt, Rn=Rn, Rt=Rt, H=H, mu=mu, tension_only=False))

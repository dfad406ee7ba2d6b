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
from rockwear.kernels.bond_laws.coulomb import Coulomb
from rockwear.kernels.bond_laws.cohesive import Cohesive

for _module in iter_modules(__path__):
    import_module(f"{__name__}.{_module.name}")

__all__ = ["BOND_LAWS", "Bond", "BondLaw", "Cohesive", "Coulomb", "ElasticBrittle", "ElasticDamage", "ElasticDomain",
           "ElastoPlasticSoftening", "Hyperbolic", "NonlinearElastoPlastic", "Parabolic"]

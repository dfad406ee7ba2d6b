"""Wear laws [Rojek 2003, 6.3-6.4], one a file: the wear rate of a surface that slides.

A law says how fast a surface loses depth w over the sliding distance s,

    pressure       dw/ds = k p_n / H                                 [Rojek 2003, eqs 6.1, 6.7], [Rojek 2014, eq. 61]
    dissipation    dw/ds = (k / mu) p_T / H                          [Rojek 2003, eqs 6.3, 6.9]
    power          dw/ds = (p_T / (tau H))^n,  tau = mu k^(-1/n)     [Rojek 2003, 6.5, one mode]
    modes          the sum of such laws over wear modes              [Rojek 2003, 6.4, 6.5]

with p_n the pressure, p_T the friction stress, mu Coulomb's coefficient, H the hardness and k dimensionless. The
reference stress tau H of the power law is written through k, so that with Coulomb friction it reads k (p_n / H)^n and
is Archard's for n = 1. A mode takes a share of the friction stress, D_i = share_i D, which the friction model gives
(adhesion and ploughing, say); its k is the one that the surface would have if all friction were of that mode.

Particles: a contact with the force F that slides by s on a particle of the area A = 2 r b wears

    V = k A s (F / (A H))^n

so a law needs no more of the contacts than the sum of F^n s by particle, over the contacts that slid: `needs` names
these sums. Where every sliding contact is at Coulomb's limit, F_T = mu F_n, the forms agree to round-off (in a cut,
where the work is of the force at the middle of a step, to the first order of the step: 0.3 % at the default). They
differ in a contact whose dashpot pulls: YADE takes mu |F_n| for its limit, and the friction there counts as dissipation
but no pressure does. Contacts that stick do not slide and wear in no form. With n different from 1 the area counts:
worn volume then depends on the size of the particles, whose contacts carry the real, uneven pressure.

A law is a subclass of `base.WearLaw` in a module of this package. It has a `name`, by which the parameter `wear_law`
chooses it, and declares its `parameters`. All modules of the package are imported here, so that a new file is enough:
the law is then in WEAR_LAWS, in --help and in every scene.
"""
from importlib import import_module
from pkgutil import iter_modules

from rockwear.kernels.wear_laws.base import FRICTION, NORMAL, WEAR_LAWS, WORK, WearLaw
from rockwear.kernels.wear_laws.dissipation import DissipationArchard
from rockwear.kernels.wear_laws.modes import SumOfModes
from rockwear.kernels.wear_laws.power import PowerLaw
from rockwear.kernels.wear_laws.pressure import PressureArchard

for _module in iter_modules(__path__):
    import_module(f"{__name__}.{_module.name}")

__all__ = ["FRICTION", "NORMAL", "WEAR_LAWS", "WORK", "DissipationArchard", "PowerLaw", "PressureArchard", "SumOfModes",
           "WearLaw"]

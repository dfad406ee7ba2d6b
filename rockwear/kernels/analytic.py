"""Exact solutions of heat conduction, to which the thermal model is compared.

They are those of the benchmarks [Rojek 2003, 7.6.1-7.6.3]; material and load are to be given in one consistent set of
units (SI here, but any set serves). Temperatures are rises above the initial one. Formulas after Carslaw and Jaeger,
Conduction of Heat in Solids. Numbers out of range raise ParameterError.
"""
import numpy as np
from scipy.special import erfc, erfcx

from rockwear.kernels.checks import not_negative, positive, require, within

_TERMS = np.arange(1, 402, 2)  # odd numbers of the sine series
_EARLY = 0.05  # Fourier number below which the images converge faster than the sine series


def diffusivity(conductivity, density, specific_heat):
    """a = lambda/(rho*c), m^2/s [Rojek 2014, eq. 58]; W/(m K), kg/m^3, J/(kg K), each greater than 0."""
    return (positive("conductivity", conductivity, "W/(m K)") / positive("density", density, "kg/m^3")
            / positive("specific_heat", specific_heat, "J/(kg K)"))


def heated_slab(x, t, *, thickness, conductivity, density, specific_heat, power):
    """Slab heated evenly inside, its faces x = 0 and x = L held at the initial temperature [Rojek 2003, 7.6.1], K.

        T = q/(2 lambda) x (L - x) - sum_{n odd} 4 q L^2/(lambda (n pi)^3) sin(n pi x/L) exp(-(n pi)^2 a t/L^2)

    x      m, scalar or array, within the slab
    t      s, at least 0; inf gives the steady state
    power  q, W/m^3
    """
    x, length = np.asarray(x, float), positive("thickness", thickness, "m")
    rate = diffusivity(conductivity, density, specific_heat) / length**2
    _inside(x, length)
    require(t >= 0, "t", t, "at least 0", "s")
    wave = np.pi * _TERMS
    series = np.sin(np.multiply.outer(x / length, wave)) @ (4 / wave**3 * np.exp(-wave**2 * rate * t))
    return power / conductivity * (x * (length - x) / 2 - length**2 * series)


def half_space_under_flux(x, t, *, flux, conductivity, density, specific_heat):
    """Half-space x >= 0 under a constant flux q through its face from t = 0 on [Rojek 2003, 7.6.2], K.

        T = 2 q sqrt(t/(lambda rho c)) ierfc(x/(2 sqrt(a t))),   ierfc(z) = exp(-z^2)/sqrt(pi) - z erfc(z)

    x  m, scalar or array, at least 0;  t  s, greater than 0;  flux  W/m^2
    """
    x, t = np.asarray(x, float), positive("t", t, "s")
    require((x >= 0).all(), "x", x.min(), "at least 0", "m")
    z = x / (2 * np.sqrt(diffusivity(conductivity, density, specific_heat) * t))
    ierfc = np.exp(-z**2) / np.sqrt(np.pi) - z * erfc(z)
    return 2 * flux * np.sqrt(t / (conductivity * density * specific_heat)) * ierfc


def sliding_half_spaces(t, *, flux, share, effusivities, conductance):
    """Faces of two half-spaces that rub on each other from t = 0 on, K, shape of t plus (2,).

    The first takes up the share alpha of the friction heat q, the second the rest [Rojek 2014, eq. 37], and they
    exchange h (T1 - T2) through their contact. By Laplace's transform, with f(x) = exp(x^2) erfc(x),

        T1 = (S + e2 D)/(e1 + e2),   T2 = (S - e1 D)/(e1 + e2),   S = 2 q sqrt(t/pi),
        D = T1 - T2 = q (alpha/e1 - (1 - alpha)/e2) (1 - f(b sqrt(t)))/b,   b = h (1/e1 + 1/e2)

    With alpha = e1/(e1 + e2), or after times t >> 1/b^2 with any other, both have the temperature S/(e1 + e2).

    t  s, scalar or array, at least 0;  flux  q, W/m^2;  share  alpha, 0 to 1;  effusivities  e1, e2, W s^0.5/(m^2 K);
    conductance  h, W/(m^2 K), at least 0
    """
    t = np.asarray(t, float)
    require((t >= 0).all(), "t", t.tolist(), "at least 0", "s")
    e1, e2 = (positive("effusivities", e, "W s^0.5/(m^2 K)") for e in effusivities)
    alpha, b = within("share", share, 0, 1), not_negative("conductance", conductance, "W/(m^2 K)") * (1 / e1 + 1 / e2)
    total = 2 * flux * np.sqrt(t / np.pi)
    weight = (1 - erfcx(b * np.sqrt(t))) / b if b else 2 * np.sqrt(t / np.pi)
    gap = flux * (alpha / e1 - (1 - alpha) / e2) * weight
    return np.stack([total + e2 * gap, total - e1 * gap], axis=-1) / (e1 + e2)


def slab_with_jumping_faces(x, t, *, thickness, conductivity, density, specific_heat, jump):
    """Slab whose faces x = 0 and x = L rise by `jump`, K, at t = 0 and stay there [Rojek 2003, 7.6.3], K.

        T/jump = 1 - sum_{n odd} 4/(n pi) sin(n pi x/L) exp(-(n pi)^2 a t/L^2)
               = sum_{k >= 0} (-1)^k [erfc((k L + x)/(2 sqrt(a t))) + erfc((k L + L - x)/(2 sqrt(a t)))]

    The second form is used while a t/L^2 < 0.05, where it needs few terms.

    x  m, scalar or array, within the slab;  t  s, greater than 0
    """
    x, t, length = np.asarray(x, float), positive("t", t, "s"), positive("thickness", thickness, "m")
    _inside(x, length)
    fourier = diffusivity(conductivity, density, specific_heat) * t / length**2
    place = x / length
    if fourier >= _EARLY:
        wave = np.pi * _TERMS
        return jump * (1 - np.sin(np.multiply.outer(place, wave)) @ (4 / wave * np.exp(-wave**2 * fourier)))
    reach = 2 * np.sqrt(fourier)
    return jump * sum((-1)**k * (erfc((k + place) / reach) + erfc((k + 1 - place) / reach)) for k in range(4))


def rod_decay_rate(*, length, diffusivity, mode=1):
    """Rate at which sin(n pi x/L) decays in a rod with cold ends (cos: insulated ends), a (n pi/L)^2, 1/s.

    length  m;  diffusivity  m^2/s;  mode  n = 1, 2, ...
    """
    return (positive("diffusivity", diffusivity, "m^2/s")
            * (positive("mode", mode) * np.pi / positive("length", length, "m"))**2)


def _inside(x, length):
    require(((x >= 0) & (x <= length)).all(), "x", x.tolist(), f"within 0 and {length:g}", "m")

"""Temperature of a tool and of the rock that it slides on, by hand: a strip of heat on two half-spaces in the plane.

The strip lies still on the tool and moves over the rock [Jaeger, Proc. R. Soc. N.S.W. 76 (1942) 203; Carslaw and
Jaeger, Conduction of Heat in Solids, 10.7]. Rises above the first temperature, K, at the hottest point of the surface,
which is otherwise insulated. half_length: l, m, half of the strip; flux: q, W/m2; conductivity: lambda, W/(m K);
density: rho, kg/m3; specific_heat: c, J/(kg K); a = lambda/(rho c). Numbers out of range raise ParameterError.
"""
import math

from scipy.optimize import brentq
from scipy.special import erf, exp1, k0e, k1e

from rockwear.kernels.analytic import diffusivity, half_space_under_flux
from rockwear.kernels.checks import positive, require

FAST = 1e6
"""v l/a from which on the limit of a fast strip serves, to some 1e-6; numbers do not tell r from 0 much beyond."""


def still_strip(t, *, half_length, flux, conductivity, density, specific_heat):
    """Rise (K) under the middle of a strip that lies still, a time t (s) after it began.

        T = 2 q/lambda sqrt(a t/pi) (erf(z) + z/sqrt(pi) E1(z^2)),   z = l/(2 sqrt(a t))

    From z << 1 on it grows as the logarithm of t, q l/(pi lambda) (2 - 0.5772 - 2 ln z).
    """
    reach = math.sqrt(diffusivity(conductivity, density, specific_heat) * positive("t", t, "s"))
    z = positive("half_length", half_length, "m") / (2 * reach)
    return 2 * flux / conductivity * reach / math.sqrt(math.pi) * (erf(z) + z / math.sqrt(math.pi) * exp1(z * z))


def moving_strip(velocity, *, half_length, flux, conductivity, density, specific_heat):
    """Highest rise (K) under a strip that has moved at the velocity v (m/s) for long.

        T = 2 q a/(pi lambda v) (s e^s (K0(s) + K1(s)) + r e^-r (K0(r) - K1(r))),   r + s = v l/a

    at the point with s behind it, e^s K0(s) = e^-r K0(r). For v l/a >> 1 it is that of a half-space under the flux for
    the time that the strip takes to pass, 2 q/lambda sqrt(2 a l/(pi v)).
    """
    a = diffusivity(conductivity, density, specific_heat)
    length = positive("velocity", velocity, "m/s") * positive("half_length", half_length, "m") / a
    if length > FAST:
        return float(half_space_under_flux(0.0, 2 * half_length / velocity, flux=flux, conductivity=conductivity,
                                           density=density, specific_heat=specific_heat))
    s = brentq(lambda s: k0e(s) - k0e(length - s) * math.exp(-2 * (length - s)), 1e-9 * length, (1 - 1e-12) * length)
    r = length - s
    under = s * (k0e(s) + k1e(s)) + r * math.exp(-2 * r) * (k0e(r) - k1e(r))
    return 2 * flux * a / (math.pi * conductivity * velocity) * float(under)


def common_share(still, moving):
    """Part of the heat that goes to the still body where both have the same highest temperature (Blok's rule).

        share = T_moving/(T_still + T_moving)

    still, moving: K, rises where each of the two took all of the heat.
    """
    require(still > 0 and moving > 0, "still", (still, moving), "rises above 0", "K")
    return moving / (still + moving)

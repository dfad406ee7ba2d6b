"""Exact solutions of small heat networks and of radiation."""
import numpy as np

from rockwear.kernels.checks import not_negative, positive, require
from rockwear.kernels.conduction import STEFAN_BOLTZMANN


def two_nodes(t, *, capacities, conductance, temperatures):
    """Temperatures of two particles that exchange heat through one contact, K, shape of t plus (2,).

        T = Tm + (T0 - Tm) exp(-H (1/C1 + 1/C2) t),   Tm = (C1 T1 + C2 T2)/(C1 + C2)

    t  s, scalar or array;  capacities  two, J/K;  conductance  H, W/K;  temperatures  the two at t = 0, K
    """
    first, second = (positive("capacities", value, "J/K") for value in capacities)
    start = np.asarray(temperatures, float)
    mean = (first * start[0] + second * start[1]) / (first + second)
    rate = not_negative("conductance", conductance, "W/K") * (1 / first + 1 / second)
    return mean + np.multiply.outer(np.exp(-rate * np.asarray(t, float)), start - mean)


def radiative_cooling_time(kelvin, *, first, surroundings, capacity, area_times_emissivity):
    """Time that a body of one temperature takes to radiate from T0 down to T, s: C dT/dt = -sigma eA (T^4 - Ts^4).

        t = C/(sigma eA) (F(T0) - F(T)),   F = ln((T - Ts)/(T + Ts))/(4 Ts^3) - atan(T/Ts)/(2 Ts^3),
        without surroundings   F = -1/(3 T^3),   that is   T = T0 (1 + 3 sigma eA T0^3 t/C)^(-1/3)

    kelvin: T, K, scalar or array, between Ts and T0; first: T0, K; surroundings: Ts, K, at least 0; capacity: C, J/K;
    area_times_emissivity: eA, m2
    """
    kelvin, cold = np.asarray(kelvin, float), not_negative("surroundings", surroundings, "K")
    first = positive("first", first, "K")
    require(((kelvin > cold) & (kelvin <= first)).all(), "kelvin", kelvin.tolist(),
            f"above {cold:g} and at most {first:g}", "K")

    def primitive(t):
        if cold == 0:
            return -1 / (3 * t**3)
        return (np.log((t - cold) / (t + cold)) - 2 * np.arctan(t / cold)) / (4 * cold**3)

    rate = STEFAN_BOLTZMANN * positive("area_times_emissivity", area_times_emissivity, "m^2") / positive(
        "capacity", capacity, "J/K")
    return (primitive(first) - primitive(kelvin)) / rate


def chain_decay_rate(*, cells, conductance, capacity, mode=1):
    """The same rate for a chain of equal particles, exactly: (4 H/C) sin^2(n pi/(2 N)), 1/s.

    cells  N, the number of contacts between cold ends, or of particles between insulated ends
    conductance  H, W/K;  capacity  C, J/K;  mode  n = 1 ... N-1

    With H = lambda b, C = rho c l b l and N = L/l it goes to rod_decay_rate as l^2.
    """
    return (4 * positive("conductance", conductance, "W/K") / positive("capacity", capacity, "J/K")
            * np.sin(positive("mode", mode) * np.pi / (2 * positive("cells", cells)))**2)

"""One contact of a particle with the two faces of a shallow inner edge.

The potential of a contact is that of the deeper face, kn d^2 / 2 with the larger depth d. It has a kink where both are
equally deep: the force jumps there, a step gives the particle energy whenever it crosses, and a soft contact, which
crosses every few steps, is thrown out of the notch. Both potentials added would have no kink there, but a step at the end
of each face. So the larger depth is rounded where the two are nearly equal.
"""

WIDTH = 0.1
"""Depths a and b are nearly equal where |a - b| / (a + b) is less. Across an edge of 2 phi the contact is then no stiffer than
kn sin^2(phi) / WIDTH, which is kn for 37 degrees."""


def joined_depth(first, second):
    """The larger of two depths (m), rounded, and its derivatives with respect to both: (m, (-, -)).

        d = (a + b) / 2 (1 + psi),  psi = |t| for |t| >= w, else t^2 / 2w + w/2,  t = (a - b) / (a + b)

    It is smooth, symmetric, and doubles where both do; so the force kn d (dd/da n_a + dd/db n_b) has a potential. (Ours.)
    Depths are greater than 0.
    """
    whole = first + second
    t = (first - second) / whole
    if abs(t) >= WIDTH:
        return max(first, second), (float(t > 0), float(t < 0))
    psi, slope = 0.5 * (t * t / WIDTH + WIDTH), t / WIDTH
    return 0.5 * whole * (1 + psi), (0.5 * (1 + psi + slope * (1 - t)), 0.5 * (1 + psi - slope * (1 + t)))

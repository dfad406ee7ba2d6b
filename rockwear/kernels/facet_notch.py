"""One contact of a particle with the two faces of a shallow inner edge.

The potential of a contact is that of the deeper face, kn d^2 / 2 with the larger depth d. It has a kink where both are
equally deep: the force jumps there, a step gives the particle energy whenever it crosses, and a soft contact, which
crosses every few steps, is thrown out of the notch. Both potentials added would have no kink there, but a step at the end
of each face. So the larger depth is rounded where the two are nearly equal.
"""

ROUNDING = 3.0
"""Width of the rounding over sin^2(phi). Across the edge a contact is so many times softer than along its normal, and an
overlap of up to 1/ROUNDING of the radius leaves the rounding before its foot on one face comes to the edge."""


def joined_depth(first, second, cosine):
    """The larger of two depths (m), rounded, and its derivatives with respect to both: (m, (-, -)).

        d = (a + b) / 2 (1 + psi),  psi = |t| for |t| >= w, else t^2 / 2w + w/2,  t = (a - b) / (a + b),  w = ROUNDING sin^2(phi)

    with 2 phi the angle between the normals of the contacts, whose cosine is given. It is smooth, symmetric, and doubles
    where both do; so the force kn d (dd/da n_a + dd/db n_b) has a potential. (Ours.) Depths are greater than 0.
    """
    whole = first + second
    t, width = (first - second) / whole, 0.5 * ROUNDING * (1 - cosine)
    if abs(t) >= width:
        return max(first, second), (float(first >= second), float(first < second))
    psi, slope = 0.5 * (t * t / width + width), t / width
    return 0.5 * whole * (1 + psi), (0.5 * (1 + psi + slope * (1 - t)), 0.5 * (1 + psi - slope * (1 + t)))

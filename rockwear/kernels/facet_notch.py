"""One contact of a particle with both facets of a shallow notch (concave edge).

With the potential of the deeper facet alone, kn d^2 / 2 of the larger overlap d, the force is discontinuous where both
overlaps are equal: each crossing of the edge gives the particle energy, and a soft contact, which crosses every few
steps, is ejected from the notch. The sum of both potentials is discontinuous at the end of each facet. So the larger
overlap is smoothed where the two are nearly equal.
"""

ROUNDING = 3.0
"""Width of the rounding over sin^2(phi). Across the edge a contact is so many times softer than along its normal. An
overlap of up to 1/ROUNDING of the radius leaves the rounding before its foot on one facet reaches the edge."""


def joined_depth(first, second, cosine):
    """Smoothed larger one of two overlaps (m), and its derivatives with respect to both: d, (dd/da, dd/db). (Ours.)

        d = (a + b) / 2 (1 + psi),  psi = |t| for |t| >= w, else t^2 / 2w + w/2
        t = (a - b) / (a + b),  w = ROUNDING sin^2(phi)

    first, second: overlaps a, b > 0 with the two facets, m; cosine: cos(2 phi) of the angle between the two contact
    normals. d is continuously differentiable, symmetric and homogeneous of degree 1, so that the force
    kn d (dd/da n_a + dd/db n_b) has a potential.
    """
    whole = first + second
    t, width = (first - second) / whole, 0.5 * ROUNDING * (1 - cosine)
    if abs(t) >= width:
        return max(first, second), (float(first >= second), float(first < second))
    psi, slope = 0.5 * (t * t / width + width), t / width
    return 0.5 * whole * (1 + psi), (0.5 * (1 + psi + slope * (1 - t)), 0.5 * (1 + psi - slope * (1 + t)))

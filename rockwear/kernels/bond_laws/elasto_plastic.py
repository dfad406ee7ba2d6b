"""Elasto-plastic bond with linear softening."""
import math

from rockwear.kernels.bond_laws.base import KN, KT, MU, RN, RT, SLOPE, ElasticDomain, LinearBondLaw

_NARROW = 1e-3
"""Width of an elastic domain, as a fraction of the strength, below which there is none: it would be left at once."""


class ElastoPlasticSoftening(LinearBondLaw):
    """Elasto-plastic bond with linear softening [Rojek 2003, eq. 4.16].

    Fn = kn (un - un_plastic), Ft = kt (ut - ut_plastic): it unloads with the elastic stiffness. Yield, with the size q
    falling from 1 to 0:

        tension      (Fn/Rn)^2 + (|Ft|/Rt)^2 = q^2
        compression   |Ft| = q Rt, and Fn stays elastic

    Flow is radial in the plane (Fn/Rn, Ft/Rt): force and plastic displacement keep the direction of the trial force, so
    the resultant of [Rojek 2003] reaches the strength while both components stay below. The size falls by

        dq = -hypot(dun_plastic/wn, |dut_plastic|/wt),      w = R/k + R/H,

    which in one direction is eq. 4.16 with the plastic modulus H' = H k/(k + H), so that H is the slope against total
    displacement. The step is implicit and solved exactly: on a proportional path, and on any path in one direction, one
    long step gives the force of many short ones; elsewhere the error is of the order of the step.

    In tension the bond breaks at q = 0. Under compression it breaks when yielding has brought q Rt down to mu |Fn|. A
    plastic elongation un_plastic > 0 is lost when the bond breaks: contact begins at the original distance. H -> inf is
    ElasticBrittle in tension, in shear and in shear with compression; in shear with tension an ellipse takes the place
    of its rectangle.

    kn, kt, H  N/m, > 0 (H may be math.inf)      Rn, Rt  N, > 0      mu  friction after breakage, >= 0
    Raises ParameterError.
    """

    name = "plastic"
    parameters = (KN, KT, RN, RT, SLOPE, MU)

    def elastic_domain(self, bond, Fn=0.0, Ft=0.0):
        """Of the rectangles in the ellipse the one whose corner is as many N from Fn as from Ft; under compression too
        strong for that, all of the shear strength and next to no tension."""
        size, u, v = 1.0 - bond.softening, self.Rn, self.Rt
        corner = _NARROW * size * u
        # ((Fn + m)/u)^2 + ((Ft + m)/v)^2 = size^2, times (u v)^2
        a, b = u * u + v * v, Fn * v * v + Ft * u * u
        root = a * (size * u * v) ** 2 - (u * v * (Fn - Ft)) ** 2
        if root > 0.0:
            corner = max(corner, Fn + (math.sqrt(root) - b) / a)
        limit_t = v * math.sqrt(max(size * size - (corner / u) ** 2, 0.0))
        domain = ElasticDomain(self.kn, self.kt, corner, limit_t)
        margin = _NARROW * size
        return domain if Fn < corner - margin * u and Ft < limit_t - margin * v else None

    def _bonded(self, bond, un, ut):
        Fn = self.kn * (un - bond.un_plastic)
        Ft = self._shear(bond, Fn, ut)
        x, y = max(Fn, 0.0) / self.Rn, math.hypot(*Ft) / self.Rt
        trial, size = math.hypot(x, y), 1.0 - bond.softening
        if trial <= size:
            return Fn, Ft

        # Radial return to the new size q: the fall size - q is (trial - q) loss, so fall (1 - loss) = excess loss.
        cos, sin = x / trial, y / trial
        # (R/k)/w = H/(H + k), in the form that H = inf leaves finite.
        loss = math.hypot(cos / (1.0 + self.kn / self.H), sin / (1.0 + self.kt / self.H))
        rest = max(1.0 - loss, 0.0)  # 0 where H = inf: compare before dividing
        fall = (trial - size) * loss
        if size * rest - fall <= rest * self.mu * max(-Fn, 0.0) / self.Rt:
            return None
        size -= fall / rest
        bond.softening = 1.0 - size
        kept = size / trial
        if Fn > 0.0:
            bond.un_plastic = un - kept * (un - bond.un_plastic)
            Fn *= kept
        return Fn, self._slip(bond, ut, Ft, kept)

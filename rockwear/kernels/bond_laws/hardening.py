"""Hardening and softening of a yield force, for the nonlinear elasto-plastic bond [Rojek 2003, eqs 4.9-4.10]."""
import math

from rockwear.kernels.checks import finite, not_negative, positive, require


class Parabolic:
    """Change of a yield force (N) with plastic displacement, b1 alpha^2 + b2 alpha + b3 [Rojek 2003, eq. 4.9].

    b1  N/m^2      b2  N/m      b3  N.      Softening must not turn into hardening, so b1 > 0 needs b2 >= 0.
    Raises ParameterError.
    """

    def __init__(self, *, b1=0.0, b2=0.0, b3=0.0):
        self.b1, self.b2, self.b3 = finite("b1", b1, "N/m^2"), finite("b2", b2, "N/m"), finite("b3", b3, "N")
        require(self.b1 <= 0.0 or self.b2 >= 0.0, "b1", self.b1, "at most 0 where b2 < 0", "N/m^2")

    def __call__(self, alpha):
        return (self.b1 * alpha + self.b2) * alpha + self.b3

    def scaled(self, factor):
        """The same curve, `factor` times as large along both axes."""
        return Parabolic(b1=self.b1 / factor, b2=self.b2, b3=self.b3 * factor)

    def flow(self, excess, k, alpha):
        """Smallest plastic step g (m) that clears `excess` (N): excess - k g = H(alpha + g) - H(alpha).

        None where the yield force falls faster than the elastic force can: the bond breaks.
        """
        slope = k + self.b2 + 2.0 * self.b1 * alpha
        root = slope * slope + 4.0 * self.b1 * excess
        return 2.0 * excess / (slope + math.sqrt(root)) if slope > 0.0 and root >= 0.0 else None


class Hyperbolic:
    """Hardening (N) of the shear yield force, b1 alpha^d / (b2 + b3 alpha^d), up to b1/b3 [Rojek 2003, eq. 4.10].

    b1  N, >= 0      b2  m^d, > 0      b3  >= 0      d  > 0
    Raises ParameterError.
    """

    def __init__(self, *, b1, b2, b3, d=1.0):
        self.b1, self.b2, self.b3 = not_negative("b1", b1, "N"), positive("b2", b2, "m^d"), not_negative("b3", b3)
        self.d = positive("d", d)

    def __call__(self, alpha):
        power = alpha ** self.d
        return self.b1 * power / (self.b2 + self.b3 * power)

    def scaled(self, factor):
        """The same curve, `factor` times as large along both axes."""
        return Hyperbolic(b1=self.b1 * factor, b2=self.b2 * factor ** self.d, b3=self.b3, d=self.d)

    def flow(self, excess, k, alpha):
        """Plastic step g (m) that clears `excess` (N): excess - k g = H(alpha + g) - H(alpha)."""
        start, low, high = self(alpha), 0.0, excess / k
        while low < (middle := 0.5 * (low + high)) < high:  # halve until no float is left between
            if excess - k * middle > self(alpha + middle) - start:
                low = middle
            else:
                high = middle
        return middle

"""Increments of velocity that the integrator applies in a step."""
import numpy as np

from rockwear.engines.memory import lists_of_forces


class VelocityIncrement:
    """Increments of velocity that YADE's integrator applies in a step, from the forces summed so far.

    masses: (n,) kg, inertias: (n,) kg m2, radii: (n,) m of the bodies 0..n-1; fixed: (n,) bool, bodies that do not
    move; gravity: Vector3, m/s2, None for none. `tables` is what kernels.compiled.velocity_at takes of it.

    The forces of a leapfrog step do the work F (v_before + v_after) / 2 dt. Near critical damping, or where a contact
    lasts a few steps, v_before in place of the mean is wrong by a third.
    """

    def __init__(self, *, masses, inertias, radii, fixed, gravity=None):
        free = ~np.asarray(fixed, bool)
        self.per_mass, self.per_inertia = (np.divide(1.0, values, out=np.zeros(len(values)), where=free)
                                           for values in (masses, inertias))
        self.count, self.radii = len(self.per_mass), np.array(radii, float)
        self.gravity = np.zeros(3) if gravity is None else np.array(gravity, float)

    def connect(self):
        """Find the lists of forces and torques of the scene that is in O now."""
        self.tables = *lists_of_forces(), self.per_mass, self.per_inertia, self.radii, self.gravity

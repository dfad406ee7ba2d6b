"""Increments of velocity that the integrator will apply in this step."""
import numpy as np
from yade import O


class VelocityIncrement:
    """Increments of velocity that YADE's integrator will apply in this step, from the forces summed so far.

    masses: (n,) kg, inertias: (n,) kg m2, radii: (n,) m of the bodies 0..n-1; fixed: (n,) bool, bodies that do not
    move; gravity: Vector3, m/s2, None for none.

    The forces of a leapfrog step do the work F (v_before + v_after) / 2 dt. Near critical damping, or where a contact
    lasts a few steps, v_before in place of the mean is wrong by a third.
    """

    def __init__(self, *, masses, inertias, radii, fixed, gravity=None):
        self.per_mass = [0.0 if fixed else 1 / m for m, fixed in zip(masses.tolist(), fixed)]
        self.per_inertia = [0.0 if fixed else 1 / i for i, fixed in zip(inertias.tolist(), fixed)]
        self.radii = np.array(radii, float)
        self.gravity = gravity

    def of(self, bodies):
        """(k, 3) m/s, changes of the velocities of bodies, integers."""
        changes = self.by_forces(bodies)
        if self.gravity:
            for change, body in zip(changes, bodies):
                if self.per_mass[body]:
                    change += np.array(self.gravity) * O.dt
        return changes

    def by_forces(self, bodies):
        """(k, 3) m/s, changes of the velocities of bodies, integers, but for gravity."""
        return self._changes(bodies, O.forces.f, self.per_mass)

    def turning(self, bodies):
        """(k, 3) rad/s, changes of the angular velocities of bodies, integers."""
        return self._changes(bodies, O.forces.t, self.per_inertia)

    @staticmethod
    def _changes(bodies, exerted, per_inertia):
        dt, rows = O.dt, []
        for body in bodies:
            one, scale = exerted(body), per_inertia[body] * dt
            rows.append((one[0] * scale, one[1] * scale, one[2] * scale))
        return np.array(rows)

"""Increments of velocity that the integrator will apply in this step."""
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
        self.radii = radii.tolist()
        self.gravity = gravity

    def of(self, body):
        """Change of a body's velocity, m/s."""
        change = O.forces.f(body) * (self.per_mass[body] * O.dt)
        return change + self.gravity * O.dt if self.gravity and self.per_mass[body] else change

    def gain(self, interaction, normal):
        """Change of the relative velocity (second to first body) at the contact point of two particles, m/s."""
        first, second, force, torque = interaction.id1, interaction.id2, O.forces.f, O.forces.t
        turn = (torque(first) * (self.radii[first] * self.per_inertia[first])
                + torque(second) * (self.radii[second] * self.per_inertia[second]))
        return (force(second) * self.per_mass[second] - force(first) * self.per_mass[first] - turn.cross(normal)) * O.dt

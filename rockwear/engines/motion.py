"""Motion: the tool led along its path, background damping of the rock, and what the step to come will change."""
import math

from yade import O, utils

from . import Engine


class Guide(Engine):
    """Leads a tool that turns along its path, chord by chord (a straight one needs no leading).

    bodies: scene.ToolBodies; clock: a function giving the time (s) along the path that YADE's positions have now;
    period: steps between visits.
    """

    name = "guide"

    def __init__(self, *, bodies, clock, period):
        super().__init__()
        self.bodies, self.clock, self.period = bodies, clock, period

    def act(self):
        # This engine comes after the integrator: positions are already those of the next step.
        self.bodies.aim(self.clock() + O.dt, self.period * O.dt)


class BackgroundDamping(Engine):
    """F = -rate m v and T = -rate I omega on the rock, as its exact solution v(t) = v(0) exp(-rate t) between visits.

    rate: 1/s; bodies: ids. The operator split costs an error of the order (rate x period) and saves a force on each
    body in each step. The kinetic energy taken is exact: YADE's sum before, times 1 - exp(-2 rate t).
    """

    name = "background_damping"

    def __init__(self, *, rate, bodies):
        super().__init__()
        self.rate, self.bodies = rate, bodies
        self.dissipated = 0.0

    def connect(self):
        states = (O.bodies[i].state for i in self.bodies)
        self.states = [state for state in states if state.blockedDOFs != "xyzXYZ"]

    def act(self):
        factor = math.exp(-self.rate * self.elapsed())
        self.dissipated += utils.kineticEnergy() * (1 - factor * factor)
        for state in self.states:
            state.vel = state.vel * factor
            state.angVel = state.angVel * factor

    def state(self):
        return {"dissipated": self.dissipated}

    def restore(self, state):
        self.dissipated = float(state["dissipated"])


class Foresight:
    """What YADE's integrator is about to add to velocities in this step, from the forces that stand now.

    masses: (n,) kg, inertias: (n,) kg m2, radii: (n,) m of the bodies 0..n-1; held: (n,) bool, bodies that do not move;
    gravity: Vector3, m/s2, None for none.
    Forces of a leapfrog step do the work F (v_before + v_after) / 2 dt; near critical damping, or where a contact lasts
    a few steps, taking v_before for the mean is off by a third.
    """

    def __init__(self, *, masses, inertias, radii, held, gravity=None):
        self.per_mass = [0.0 if fixed else 1 / m for m, fixed in zip(masses.tolist(), held)]
        self.per_inertia = [0.0 if fixed else 1 / i for i, fixed in zip(inertias.tolist(), held)]
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

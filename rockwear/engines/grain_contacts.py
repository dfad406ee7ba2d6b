"""Energy in and lost at the contacts of loose spheres, whose law is YADE's Hertz-Mindlin law."""
from yade import Law2_ScGeom_MindlinPhys_Mindlin, O

from rockwear.engines import access
from rockwear.engines.base import Engine


class GrainContacts(Engine):
    """Sums of what YADE's law counts itself: friction_work and damping_work, J lost to sliding and to the dashpots.

    YADE does not save its sums. `act`, at a point where the scene is loaded afresh, takes them over: a resumed run then
    adds up the same numbers in the same order. YADE counts no work of rolling resistance.
    """

    name = "grain_contacts"

    def __init__(self):
        super().__init__(period=None)
        self.friction_taken = self.damping_taken = 0.0

    def connect(self):
        self.law = access.law_functor(Law2_ScGeom_MindlinPhys_Mindlin)

    def act(self):
        self.friction_taken, self.damping_taken = self.friction_work, self.damping_work
        self.law = None

    @property
    def friction_work(self):
        """J lost to sliding."""
        return self.friction_taken + self.law.frictionDissipation

    @property
    def damping_work(self):
        """J lost to the dashpots, normal and tangential."""
        return self.damping_taken + (self.law.normDampDissip + self.law.shearDampDissip)

    def elastic_energy(self):
        """J in the springs: 2/5 Fn un of Hertz's, Ft^2/2kt and M^2/2kr.

        The overlap follows from the force: YADE does not save the overlap itself.
        """
        energy = 0.0
        for contact in O.interactions:
            phys = contact.phys
            normal = (phys.normalForce - phys.normalViscous).norm()
            if normal > 0:
                energy += 0.4 * normal * (normal / phys.kno)**(2 / 3) + 0.5 * phys.shearElastic.squaredNorm() / phys.ks
                energy += 0.5 * phys.momentBend.squaredNorm() / phys.kr if phys.kr else 0.0
        return energy

    def state(self):
        return {"friction_taken": self.friction_taken, "damping_taken": self.damping_taken}

    def restore(self, state):
        self.friction_taken, self.damping_taken = float(state["friction_taken"]), float(state["damping_taken"])

    def log(self):
        return {"friction_work": (self.friction_work, "J"), "damping_work": (self.damping_work, "J")}

"""What the tool meets: forces, friction work and Archard wear of its skin, and the removal of its particles."""
import math

import numpy as np
from yade import O, utils

from ..kernels.archard import worn_volume
from . import Engine, contact_energy, law_functor


class ToolContact(Engine):
    """Samples the contacts of the tool's skin: force, friction work by particle, and who touches whom.

    tool: the tool's bodies (see scene.ToolBodies); velocity: (2,) m/s.

    The friction work since the last visit is exactly what YADE's law dissipated; |Ft| times slip of the contacts found
    sliding now only says where it went, so that the shares add up to the whole. Tool work, F v dt, and the contact
    dashpots, cn vn^2 dt, are sampled at each visit.
    """

    name = "tool_contact"

    def __init__(self, *, tool, particles, velocity):
        super().__init__()
        self.tool, self.velocity = tool, velocity
        self.tool_work = np.zeros(tool.count)
        self.rock_work = np.zeros(particles)
        self.wearing_work = np.zeros(tool.count)
        self.touching = {}
        self.booked = self.friction_dissipated = 0.0
        self.work_done = self.dashpot_dissipated = 0.0
        self.impulse = np.zeros(2)
        self.force = np.zeros(2)

    def connect(self):
        self.law = law_functor("Law2_ScGeom_FrictViscoPhys_CundallStrackVisco")

    def act(self):
        elapsed = self.elapsed()
        ids = self.tool.ids
        self.force = np.array([utils.sumForces(ids, (1, 0, 0)), utils.sumForces(ids, (0, 1, 0))])
        self.impulse += self.force * elapsed
        self.work_done -= float(self.force @ self.velocity) * elapsed
        with_body, sliding = O.interactions.withBody, []
        for index, body in self.tool.body_of.items():
            for interaction in with_body(body):
                rock = interaction.id1 if interaction.id2 == body else interaction.id2
                phys = interaction.phys
                self.touching[index, rock] = self.touching.get((index, rock), 0.0) + elapsed
                if phys.cn > 0:
                    self.dashpot_dissipated += elapsed * self._dashpot_power(interaction, phys, body, rock)
                tangential = phys.shearForce.norm()
                if tangential > 0 and tangential >= 0.999 * phys.tangensOfFrictionAngle * phys.normalForce.norm():
                    sliding.append((index, rock, tangential * interaction.geom.shearInc.norm()))
        self._share(sliding)

    @staticmethod
    def _dashpot_power(interaction, phys, body, rock):
        """W of the force cn vn over the mean of vn before the step, which made it, and after."""
        force = phys.normalViscous
        apart = O.bodies[rock].state.vel - O.bodies[body].state.vel
        after = apart if interaction.id2 == rock else -apart
        return 0.5 * (force.squaredNorm() / phys.cn + force.dot(after))

    def _share(self, sliding):
        weight = math.fsum(w for _, _, w in sliding)
        if weight <= 0:
            return
        total = self.law.plasticDissipation() - self.booked
        for index, rock, w in sliding:
            work = total * w / weight
            self.tool_work[index] += work
            self.wearing_work[index] += work
            self.rock_work[rock] += work
        self.booked += total

    def take_wearing_work(self):
        """(m,) friction work (J) at each tool particle since the last call, for wear."""
        taken, self.wearing_work = self.wearing_work, np.zeros(self.tool.count)
        return taken

    def take_heating(self):
        """Friction work (J) at tool and rock particles, and seconds in touch by (tool, rock) pair, since the last call."""
        taken = self.tool_work, self.rock_work, self.touching
        self.tool_work, self.rock_work = np.zeros(self.tool.count), np.zeros(len(self.rock_work))
        self.touching = {}
        return taken

    def take_impulse(self):
        """(2,) impulse (N s) on the tool since the last call."""
        taken, self.impulse = self.impulse, np.zeros(2)
        return taken

    def elastic_energy(self):
        """Strain energy (J) of the tool's contacts."""
        return contact_energy(i for body in self.tool.ids for i in O.interactions.withBody(body))

    @property
    def friction(self):
        """All friction work between tool and rock so far, J: YADE's own account."""
        return self.law.plasticDissipation()

    def state(self):
        pairs = sorted(self.touching)
        return {"tool_work": self.tool_work, "rock_work": self.rock_work, "wearing_work": self.wearing_work,
                "touching": np.array([(i, j, self.touching[i, j]) for i, j in pairs], float).reshape(-1, 3),
                "booked": self.booked, "dissipation": self.friction, "work_done": self.work_done,
                "dashpot_dissipated": self.dashpot_dissipated, "impulse": self.impulse}

    def restore(self, state):
        for name in ("tool_work", "rock_work", "wearing_work", "impulse"):
            setattr(self, name, state[name].copy())
        self.touching = {(int(i), int(j)): t for i, j, t in state["touching"].tolist()}
        for name in ("booked", "work_done", "dashpot_dissipated"):
            setattr(self, name, float(state[name]))
        law_functor("Law2_ScGeom_FrictViscoPhys_CundallStrackVisco").initPlasticDissipation(float(state["dissipation"]))


class Wear(Engine):
    """Archard wear with H(theta) (M 6.9, P 61), V = (k / mu) W / H, and the removal of particles worn away.

    contact: the ToolContact that says where friction works; erosion: kernels.erosion.Erosion of the tool;
    coefficient: Archard's k times the acceleration factor; temperature: a function giving (m,) K of the tool particles.
    """

    name = "wear"

    def __init__(self, *, contact, erosion, tool, coefficient, mu, hardness, temperature, on_removal):
        super().__init__()
        self.contact, self.erosion, self.tool = contact, erosion, tool
        self.coefficient, self.mu, self.hardness, self.temperature = coefficient, mu, hardness, temperature
        self.on_removal = on_removal
        self.contact_energy_removed = 0.0

    def act(self):
        work = self.contact.take_wearing_work()
        if not work.any():
            return
        volume = worn_volume(k=self.coefficient, mu=self.mu, work=work, hardness=self.hardness(self.temperature()))
        removed, uncovered = self.erosion.wear(volume)
        if removed:
            self._remove(removed, uncovered)

    def _remove(self, removed, uncovered):
        loose = self.erosion.detached().tolist()
        self.erosion.drop(loose)
        gone = removed + loose
        self.contact_energy_removed += self.tool.erase(gone)
        self.tool.add([i for i in uncovered if self.erosion.alive[i]])
        self.on_removal(gone)

    def state(self):
        return {"contact_energy_removed": self.contact_energy_removed, **self.erosion.state()}

    def restore(self, state):
        self.contact_energy_removed = float(state["contact_energy_removed"])
        self.erosion.restore(state)

    def log(self):
        return {"mass_lost": (self.erosion.mass_fraction_lost, "-"),
                "worn_volume": (self.erosion.archard_volume, "m3")}

"""Kratos's side of kratos.py: builds the model that kratos.write left in this folder, runs it, writes result.json.

The script is run by the Python of the peer's environment, which has Kratos and numpy only. Each disc has properties of
its own while bonds are made, because a bond takes its strength from the properties of its pair and keeps them; then all
discs have those of the rock, which name the contacts of rock and tool.
"""
import json
import time
from pathlib import Path

import KratosMultiphysics as core
import KratosMultiphysics.DEMApplication as dem
import numpy as np
from KratosMultiphysics.DEMApplication.DEM_analysis_stage import DEMAnalysisStage

ROCK, TOOL, FIRST = 1, 2, 3
"""Numbers of properties: of the rock, of the tool, of the first disc."""
MOTIONS = "VELOCITY_X", "VELOCITY_Y", "VELOCITY_Z", "ANGULAR_VELOCITY_X", "ANGULAR_VELOCITY_Y", "ANGULAR_VELOCITY_Z"
OUT_OF_PLANE = MOTIONS[2:5]
BOND, SPRINGS, NOTHING = "DEM_KDEM2D", "DEM_D_Linear_Custom_Constants", "DEM_D_void"
"""Laws of bonds, of contacts, and of particles of the tool among themselves."""
AREAS = core.KratosGlobals.GetVariable("NEIGHBOURS_CONTACT_AREAS")


def give(properties, values):
    """Set {name of a variable: value}."""
    for name, value in values.items():
        properties[core.KratosGlobals.GetVariable(name)] = value


def relation(other, law, values):
    """Properties of a pair: those of its contact with particles that have properties `other`."""
    found = core.Properties(other)
    give(found, {**values, "DEM_DISCONTINUUM_CONSTITUTIVE_LAW_NAME": law})
    return found


def bond(other, values, tau):
    """Properties of a pair that is bonded. tau: Pa for an area of 1."""
    found = relation(other, SPRINGS, {**values, "CONTACT_TAU_ZERO": tau,
                                      "DEM_CONTINUUM_CONSTITUTIVE_LAW_NAME": BOND})
    getattr(dem, BOND)().SetConstitutiveLawInProperties(found, False)
    return found


class Cut(DEMAnalysisStage):
    """Discs, bonds and tool of `arrays`, with the constants of `job`."""

    def __init__(self, arrays, job):
        self.arrays, self.job = arrays, job
        self.discs = len(arrays["radii"])
        super().__init__(core.Model(), core.Parameters(json.dumps(job["settings"])))
        self.Initialize()
        rock = self.spheres_model_part.GetProperties()[ROCK]
        particles = list(self.spheres_model_part.Elements)
        self.bonds = np.array([len(particle.GetValue(AREAS)) for particle in particles[:self.discs]])
        if (self.bonds != np.bincount(arrays["pairs"].ravel(), minlength=self.discs)).any():
            raise ValueError("Kratos bonds other discs than the model")
        for particle, count in zip(particles[:self.discs], self.bonds.tolist()):
            particle.SetValue(AREAS, core.Vector([1.0] * count))
            particle.Properties = rock
        nodes = list(self.spheres_model_part.Nodes)
        self.rock, self.tool = nodes[:self.discs], nodes[self.discs:]

    def ReadModelParts(self, *_):
        """Particles and their motion. Particles of one group are bonded where they touch; 0 is none."""
        arrays, part = self.arrays, self.spheres_model_part
        for number in range(ROCK, FIRST + self.discs):
            part.CreateNewProperties(number)
        for i, (place, radius, fixed) in enumerate(zip(arrays["positions"], arrays["radii"], arrays["fixed"])):
            self.add(part, i + 1, place, radius, FIRST + i, group=1, fixed=MOTIONS if fixed else OUT_OF_PLANE)
        for i, (place, radius) in enumerate(zip(arrays["tool_positions"], arrays["tool_radii"]), self.discs + 1):
            node = self.add(part, i, place, radius, TOOL, group=0, fixed=MOTIONS)
            node.SetSolutionStepValue(core.VELOCITY_X, self.job["tool_velocity"])
        self.model_parts_have_been_read = True
        self.all_model_parts.ComputeMaxIds()

    def add(self, part, number, place, radius, properties, *, group, fixed):
        """Add a particle. fixed: names of motions that are prescribed, at rest unless set. -> its node."""
        node = part.CreateNewNode(number, *place.tolist(), 0.0)
        node.SetSolutionStepValue(core.RADIUS, float(radius))
        node.SetSolutionStepValue(dem.COHESIVE_GROUP, group)
        for name in MOTIONS:
            variable = core.KratosGlobals.GetVariable(name)
            node.AddDof(variable)
            if name in fixed:
                node.Fix(variable)
        part.CreateNewElement(self.job["settings"]["ElementType"], number, [number], part.GetProperties()[properties])
        return node

    def SetMaterials(self):
        """Properties of the particles and of their pairs."""
        of_rock, of_tool = self.job["of_rock"], self.job["of_tool"]
        kinds = self.spheres_model_part.GetProperties()
        for number in range(ROCK, FIRST + self.discs):
            give(kinds[number], self.job["disc"])
        kinds[ROCK].AddSubProperties(relation(ROCK, SPRINGS, of_rock))
        kinds[ROCK].AddSubProperties(relation(TOOL, SPRINGS, of_tool))
        kinds[TOOL].AddSubProperties(relation(ROCK, SPRINGS, of_tool))
        kinds[TOOL].AddSubProperties(relation(TOOL, NOTHING, of_tool))
        for (i, j), tau in zip((FIRST + self.arrays["pairs"]).tolist(), self.arrays["tau"].tolist()):
            kinds[i].AddSubProperties(bond(j, of_rock, tau))
            kinds[j].AddSubProperties(bond(i, of_rock, tau))

    def step(self):
        """One step: forces at the present places, then motion."""
        solver = self._GetSolver()
        self.time = solver.AdvanceInTime(self.time)
        solver.InitializeSolutionStep()
        solver.SolveSolutionStep()
        solver.FinalizeSolutionStep()

    def sample(self, step):
        """[step, Fx, Fy of the rock on the tool, N/m, intact bonds], forces at the start of the last step."""
        force = np.sum([list(node.GetSolutionStepValue(dem.CONTACT_FORCES)) for node in self.tool], axis=0)
        intact = 1 - np.array([node.GetSolutionStepValue(dem.DAMAGE_RATIO) for node in self.rock])
        return [step, force[0], force[1], round(intact @ self.bonds / 2)]  # each bond counts at both of its discs

    def run(self):
        """(samples, seconds of processor time per step of the timed ones)."""
        rows, seconds, begin = [], 0.0, time.process_time()
        for step in range(self.job["steps"] + 1):
            self.step()
            if step % self.job["sample"] == 0:
                rows.append(self.sample(step))
            if step == self.job["timed"]:
                seconds = (time.process_time() - begin) / (step + 1)
        return rows, seconds

    def stretch(self):
        """[N] of the bonds, tension positive, after the strain of the job."""
        places = self.arrays["positions"]
        for node, (x, y) in zip(self.rock, (places + places @ np.transpose(self.job["strain"])).tolist()):
            node.X, node.Y = x, y
        self.spheres_model_part.ProcessInfo[dem.IS_TIME_TO_PRINT] = True
        solver = self._GetSolver()
        solver.SolveSolutionStep()
        solver.PrepareContactElementsForPrinting()
        found = {tuple(sorted(node.Id - 1 for node in pair.GetNodes())): -pair.GetValue(dem.LOCAL_CONTACT_FORCE)[2]
                 for pair in self.contact_model_part.Elements}
        return [found[tuple(sorted(pair))] for pair in self.arrays["pairs"].tolist()]


def main():
    """Build, run and write."""
    core.Logger.GetDefaultOutput().SetSeverity(core.Logger.Severity.WARNING)
    job = json.loads(Path("kratos.json").read_text(encoding="utf-8"))
    scene = Cut(dict(np.load("kratos.npz")), job)
    if "strain" in job:
        result = {"forces": scene.stretch()}
    else:
        rows, seconds = scene.run()
        result = {"rows": rows, "seconds": seconds}
    Path("result.json").write_text(json.dumps(result), encoding="utf-8")


if __name__ == "__main__":
    main()

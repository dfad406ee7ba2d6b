"""The three heat benchmarks of [Rojek 2003, 7.6] on packings of discs, beside their exact solutions; heat only.

The source takes them from a finite element program's manual and shows figures that cannot be read here: the exact
solutions (kernels.analytic) stand for them, at the source's instants. The numbers are the source's, in one consistent
set of units.
"""
from collections import namedtuple
from types import SimpleNamespace

import numpy as np
from yade import O

from rockwear.scenes import yade_scene
from rockwear.scenes.output import Output
from rockwear.scenes.parameters import BOND_CONDUCTANCE
from rockwear.scenes.scene import Scene
from rockwear.run import vtk
from rockwear.engines.bonds import Bonds
from rockwear.engines.conduction import Conduction
from rockwear.engines.recorder import Recorder
from rockwear.kernels import analytic
from rockwear.kernels.bond_laws import ElasticBrittle
from rockwear.kernels.voronoi import among, conducting
from rockwear.kernels.conduction import HeatNetwork, calibrated_conductance, paths
from rockwear.kernels.checks import require
from rockwear.kernels.parameter import Group, Parameter, above_zero, choice, integer, number
from rockwear.model.rock import Arranged, Specimen

Benchmark = namedtuple("Benchmark", "title depth material load instants")
"""Depth (m) that is modelled, its material, the load of its exact solution, and the instants (s) of its profiles."""

BENCHMARKS = {
    "slab_source": Benchmark("heat generated in a slab between cold faces [Rojek 2003, 7.6.1]", 8.0,
                             dict(conductivity=16.0, density=1.0, specific_heat=1.0), 2000.0, (0.08, 0.16, 0.24, 0.32)),
    # At t = 1 heat has come 6 deep to a part of 1e-5 only. the source names the last instant.
    "half_space": Benchmark("half-space under unit flux [Rojek 2003, 7.6.2]", 6.0,
                            dict(conductivity=1.0, density=1.0, specific_heat=1.0), 1.0, (0.25, 0.5, 1.0)),
    # the source names the last instant.
    "jump": Benchmark("slab whose faces jump to 100 [Rojek 2003, 7.6.3]", 1.0,
                      dict(conductivity=6.0, density=3.0, specific_heat=2.0), 100.0, (0.025, 0.05, 0.075)),
}
PACKINGS = "random", "square", "triangular"

NO_LAW = ElasticBrittle(kn=1.0, kt=1.0, Rn=1.0, Rt=1.0, mu=0.0)
"""Of bonds that are never strained."""

GROUPS = [Group("benchmark", (
    Parameter("benchmark", "all", "", choice("all", *BENCHMARKS), "of [Rojek 2003, 7.6]", "[Rojek 2003, 7.6]"),
    Parameter("packing", "all", "", choice("all", *PACKINGS), "of the discs"),
    Parameter("across", 80, "", integer(16), "mean diameters across the depth: 80 make about 1800 discs"),
    Parameter("refinements", 3, "", integer(1), "resolutions, each twice as fine as the one before, `across` the last"),
    Parameter("aspect", 0.25, "", number(0.1, 10), "height of the specimen over its depth"),
    Parameter("radius_ratio", 1.5, "", number(1, 4), "largest over smallest radius of the random packing",
              "[Rojek 2003, 5.1]"),
    Parameter("porosity", 0.12, "", number(0), "of the random packing", "[Rojek 2014, 5.2]"),
    Parameter("seed", 1, "", integer(0), "of the random packing"),
    BOND_CONDUCTANCE,
    Parameter("step_fraction", 0.5, "", above_zero, "heat step over the stable one, at most 1",
              "calibration/results/heat.md")))]

Case = namedtuple("Case", "benchmark packing across specimen network step")
"""One benchmark on one specimen of so many diameters across: its HeatNetwork at t = 0 and its longest heat step, s."""


def specimen(packing, *, depth, across, v):
    """Discs of mean diameter depth/across in a box of the parameters' aspect."""
    radius, density = depth / (2 * across), 1.0
    if packing == "random":
        smallest = 2 * radius / (1 + v.radius_ratio)
        return Specimen(width=depth, height=v.aspect * depth, radius_min=smallest, radius_max=v.radius_ratio * smallest,
                        porosity=v.porosity, seed=v.seed, bonding_gap=0.1 * smallest, density=density)
    rows = max(2, round(v.aspect * across * (1 if packing == "square" else 2 / np.sqrt(3))))
    rise, shift = (2.0, 0.0) if packing == "square" else (np.sqrt(3), 1.0)
    places = np.array([(1 + 2 * k + shift * (row % 2), 1 + rise * row) for row in range(rows)
                       for k in range(across - int(shift) * (row % 2))])
    return Arranged(positions=radius * places, radius=radius, width=depth, height=radius * (2 + rise * (rows - 1)),
                    density=density)


def exact(name, x, t):
    """Temperature of the benchmark `name` at depths x (m) and the time t (s)."""
    case = BENCHMARKS[name]
    if name == "slab_source":
        return analytic.heated_slab(x, t, thickness=case.depth, power=case.load, **case.material)
    if name == "half_space":
        return analytic.half_space_under_flux(x, t, flux=case.load, **case.material)
    return analytic.slab_with_jumping_faces(x, t, thickness=case.depth, jump=case.load, **case.material)


def network(name, rock, model):
    """The benchmark's HeatNetwork over a specimen at t = 0: its capacities, paths, faces and sources."""
    load, material = BENCHMARKS[name].load, BENCHMARKS[name].material
    conductivity, heat = material["conductivity"], material["density"] * material["specific_heat"]
    capacity = heat * (rock.cells.volumes if model == "voronoi" else rock.masses / rock.density)
    edges, conductance = paths(
        model, conductivity, pairs=rock.pairs, cells=lambda: rock.cells, fitted=lambda: calibrated_conductance(
            positions=rock.positions, edges=rock.pairs, conductance=1.0, conductivity=conductivity)[0])
    found = HeatNetwork(capacity=capacity, edges=edges, conductance=conductance, temperature=0.0)
    if name == "half_space":
        nodes, areas, _ = rock.cells.walls[0]
        found.source(nodes, load * areas)
        return found
    for side in (0, 1):
        nodes, conductance = rock.cells.wall_conductance(side, conductivity)
        found.convect(nodes, conductance, load if name == "jump" else 0.0)
    if name == "slab_source":
        found.source(range(rock.count), load * capacity / heat)
    return found


class HeatBenchmarks(Scene):
    """Cases one after the other, a stage an instant. values: {name: value} of all GROUPS.

    The discs and their bonds are in YADE, at rest: its loop holds nothing but the visits of the heat.
    """

    def __init__(self, values):
        super().__init__()
        v = self.v = SimpleNamespace(**values)
        require(v.step_fraction <= 1, "step_fraction", v.step_fraction, "at most 1, the stable step")
        coarsest = v.across / 2 ** (v.refinements - 1)
        require(coarsest >= 16 and coarsest == int(coarsest), "refinements", v.refinements,
                f"such that across = {v.across} can be halved so often to a whole number of at least 16")
        self.cases, self.plan = [], []
        for packing in PACKINGS if v.packing == "all" else [v.packing]:
            for k in reversed(range(v.refinements)):
                for name in BENCHMARKS if v.benchmark == "all" else [v.benchmark]:
                    self._add(name, packing, v.across // 2**k)
        self.stages = [(case.benchmark, steps) for case, _, steps, _ in self.plan]
        self.chunk = 10**6
        self.errors, self.case_balances = np.full((len(self.plan), 2), np.nan), np.zeros((len(self.cases), 3))
        self.output = BenchmarkOutput(self)
        self._stand()

    def _add(self, name, packing, across):
        rock = specimen(packing, depth=BENCHMARKS[name].depth, across=across, v=self.v)
        made = network(name, rock, self.v.bond_conductance)
        case = Case(name, packing, across, rock, made, self.v.step_fraction * made.stable_step())
        self.cases.append(case)
        instants = BENCHMARKS[name].instants
        for before, instant in zip((0.0, *instants), instants):
            steps = int(np.ceil((instant - before) / case.step * (1 - 1e-9)))
            self.plan.append((case, instant, steps, (instant - before) / steps))

    def _stand(self):
        """Be at the present stage; after the last one stay there."""
        self.case, self.instant, _, self.time_step = self.plan[min(self.stage, len(self.plan) - 1)]
        self.rock = self.case.specimen

    # ---- YADE

    def build(self):
        """Fill YADE's scene with the discs and bonds of the present case, and insert its heat engine."""
        O.reset()
        yade_scene.put_rock_materials(mu=0.0)
        yade_scene.put_rock(self.rock)
        yade_scene.put_loop(rock=NO_LAW)
        self._make_engines()
        bonds = Bonds(pairs=self.rock.pairs, law=NO_LAW, clock=lambda: 0.0)
        yade_scene.make_bonds(self.rock, bonds)
        bonds.connect()
        self._cut_open_paths(bonds)
        for i in range(self.rock.count):
            O.bodies[i].state.blockedDOFs = "xyzXYZ"
        self._insert_engines()

    def _make_engines(self):
        self.heat = Conduction(network=self.case.network, step=self.case.step)
        steps = 1 if self.finished else self.stages[self.stage][1]
        self.recorder = Recorder([self.output.log], period=max(1, steps // 10),
                                 history=self.recorder.history if hasattr(self, "recorder") else None)
        self._register(self.heat, self.recorder)

    def _cut_open_paths(self, bonds):
        """Heat passes bonds that YADE holds, and pores that they close."""
        edges, conductance, n = self.heat.network.edges, self.heat.network.conductance, self.rock.count
        bonded = among(edges, bonds.pairs[bonds.in_contact()], n)
        left = conducting(edges, bonded, ~among(edges, bonds.pairs, n), n)
        self.heat.network.rewire(edges=edges[left], conductance=conductance[left])

    def _insert_engines(self):
        # Nothing moves: YADE's own engines have nothing to do.
        O.engines = O.engines[-1:]
        super()._insert_engines()
        O.engines = O.engines[1:]

    def canonical(self):
        """Let the last step's heat pass. (Nothing moves: every state is one that a loaded scene has too.)"""
        self.heat.act()

    def end_stage(self, folder):
        """Compare with the exact solution; on to the next instant, or to the next case from t = 0."""
        gap = np.abs(self.heat.network.temperature - self.expected()) / self.expected().max()
        self.errors[self.stage] = gap.max(), np.sqrt(np.mean(gap**2))
        case, balance, stored = self.case, self.heat.network.balance, self.heat.network.heat_content
        self.case_balances[self.cases.index(
            case)] = balance["generated"], balance["convected"], stored - sum(balance.values())
        super().end_stage(folder)
        self._stand()
        if self.finished:
            return
        if self.case is case:
            O.dt = self.time_step
        else:
            self.build()

    # ---- what a checkpoint holds

    def state(self):
        return {**super().state(), "errors": self.errors.copy(), "balances": self.case_balances.copy()}

    def restore(self, state, directory, folder):
        self.stage = int(state["stage"])
        self._stand()
        super().restore(state, directory, folder)
        self.errors, self.case_balances = state["errors"].copy(), state["balances"].copy()

    def expected(self):
        """(n,) the exact temperature at the discs' centres at the present instant."""
        return exact(self.case.benchmark, self.rock.positions[:, 0], self.instant)


class BenchmarkOutput(Output):
    """What the folder of heat benchmarks shows."""

    def log(self):
        """{name: (value, unit)} of the history."""
        temperature = self.scene.heat.network.temperature
        return {"time": (self.scene.time, "s"), "stage": (self.scene.stage, "-"),
                "temperature_max": (temperature.max(), "-"),
                "heat_content": (self.scene.heat.network.heat_content, "-")}

    def _of(self, case):
        """(instants, 2) greatest and root mean square error of a case, parts of the temperature range."""
        return self.scene.errors[[k for k, planned in enumerate(self.scene.plan) if planned[0] is case]]

    def results(self):
        """{name: (value, unit)}: errors as parts of the range at their instant, and orders over the resolutions."""
        found, finest = {}, [case for case in self.scene.cases if case.across == self.scene.v.across]
        for case in finest:
            errors, name = self._of(case), f"{case.benchmark}_{case.packing}"
            found[f"{name}_largest_error"] = float(errors[:, 0].max()), "-"
            found[f"{name}_rms_error"] = float(errors[:, 1].max()), "-"
            same = [other for other in self.scene.cases if (other.benchmark, other.packing) == case[:2]]
            if len(same) > 1:
                rms = [self._of(other)[-1, 1] for other in same]
                order = -np.polyfit(np.log([other.across for other in same]), np.log(rms), 1)[0]
                found[f"{name}_order_in_space"] = float(order), "-"
            found[f"{name}_discs"] = case.specimen.count, "-"
        return found

    def tables(self):
        """errors.csv: every case and instant, benchmarks and packings by their numbers in BENCHMARKS and PACKINGS."""
        rows = [(list(BENCHMARKS).index(case.benchmark), PACKINGS.index(case.packing), case.across, case.specimen.count,
                 instant, steps, *error) for (case, instant, steps, _), error in zip(self.scene.plan,
                                                                                     self.scene.errors)]
        header = "benchmark packing across discs instant steps largest_error rms_error".split()
        return {"errors.csv": ([f"{name} [{'s' if name == 'instant' else '-'}]" for name in header], rows)}

    def balances(self):
        """The heat balance, sum of all cases: generated, through the faces, stored, and what does not add up."""
        generated, through, residual = self.scene.case_balances.sum(axis=0)
        return {"heat": ({"generated": generated, "through_faces": through, "stored": generated + through + residual,
                          "residual": residual}, "-")}

    def model(self):
        """Arrays that stay the same all through a run: of each case, and where a stage stands in it."""
        arrays = {"heat_cases": np.array([f"{c.benchmark}/{c.packing}/{c.across}" for c in self.scene.cases]),
                  "stage_case": np.array([self.scene.cases.index(case) for case, *_ in self.scene.plan]),
                  "stage_instant": np.array([instant for _, instant, *_ in self.scene.plan]),
                  "stage_steps": np.array([steps for _, _, steps, _ in self.scene.plan])}
        for k, case in enumerate(self.scene.cases):
            arrays[f"positions_{k}"], arrays[f"radii_{k}"] = case.specimen.positions, case.specimen.radii
        return arrays

    def snapshot(self):
        """Arrays that show the scene now; `exact` is that of the instant to which the stage approach_steps."""
        return {"time": self.scene.time, "stage": min(self.scene.stage, len(self.scene.plan) - 1),
                "temperature": self.scene.heat.network.temperature, "exact": self.scene.expected()}

    def write_vtk(self, folder, number):
        """rock.NNNN.vtp: diameter, temperature, exact temperature."""
        shot = self.snapshot()
        vtk.write(folder, "rock", number, self.scene.time, self.scene.rock.positions,
                  {"diameter": 2 * self.scene.rock.radii, "temperature": shot["temperature"], "exact": shot["exact"]})

    def progress(self):
        """A few words on how it stands."""
        return f"{self.scene.case.packing}, {self.scene.case.across} across, {self.scene.rock.count} discs"

"""The life cycle of every scene."""
from yade import InsertionSortCollider, O, utils

from rockwear.engines import access, base
from rockwear.engines.bonds import Crack


NEVER = 2**62
"""Steps that no run has."""


class Scene:
    """What rockwear.run approach_steps: bonded rock with engines, in stages of steps, over canonical points, into checkpoints.

    A scene sets `rock` (a Specimen) and `time_step` (s), and plans its stages. `build` fills YADE's scene;
    `_make_engines` makes `bonds`, `rock_friction`, `recorder` and lists all engines in `live`, in the order of their
    visits; `_periods` says how often each is visited, None for one that others call. `model`, `snapshot`, `progress`,
    `results` and `balances` say what a run's folder shows.
    """

    leading = {"shear_rotation"}
    """Engines that come first in a step, before its forces."""
    looking = {"bonds", "rock_friction"}
    """Engines that look at the forces of this step and come before the integrator; the others come after it."""
    time_scale = 1.0
    """Seconds of the process in a second of the mechanics (M 12.1: "mechanical process scaled"). All times of a scene
    but its time step are those of the process."""

    def _plan(self, stages):
        """stages: {name: s}."""
        # Chunks between canonical points depend on the scene alone, so that every run of it passes the same points.
        self.chunk = int(min(2000, max(100, 12_000_000 // max(1, len(self.rock.pairs)))))
        self.stages = [(name, max(1, self._steps(seconds))) for name, seconds in stages.items()]
        self.stage, self.clock = 0, 0.0

    def _steps(self, seconds):
        """Steps in so many seconds of the process."""
        return round(min(seconds / (self.time_step * self.time_scale), NEVER))

    def _register(self, *live):
        """Make these engines the scene's own; None stands for one that it does not need."""
        self.live = [engine for engine in live if engine]
        base.register(self.live)

    def _insert_engines(self):
        """Hang the engines into YADE's loop, from now on with the scene's time step."""
        O.dt = self.time_step
        periods = self._periods()
        names = [engine.name for engine in self.live if periods[engine.name]]
        first = [name for name in names if name in self.leading]
        before = [name for name in names if name in self.looking]
        after = [name for name in names if name not in self.leading | self.looking]
        first, before, after = (base.runners({name: periods[name] for name in group}) for group in (first, before, after))
        O.engines = first + O.engines[:-1] + before + O.engines[-1:] + after
        self._connect()
        self.first_iteration = O.iter

    def _connect(self):
        for engine in self.live:
            engine.last_iteration = O.iter - 1
            engine.connect()

    # ---- stages

    @property
    def step(self):
        """Steps of the present stage that are done."""
        return O.iter - self.first_iteration

    @property
    def time(self):
        """Simulated seconds over all stages."""
        return self.clock + self.step * self.time_step * self.time_scale

    @property
    def finished(self):
        """True after the last stage."""
        return self.stage >= len(self.stages)

    @property
    def stage_done(self):
        """True when the present stage has run all its steps."""
        return self.step >= self.stages[self.stage][1]

    def run_chunk(self):
        """Run to the next canonical point. Raises what an engine raised, RunEnded among it."""
        O.run(min(self.chunk, self.stages[self.stage][1] - self.step), True)
        if base.failures:
            raise base.failures.pop()
        self.canonical()

    def canonical(self):
        """Bring YADE into the one state that a saved and loaded scene has too: no half-found contacts, bounds fresh.

        Without it a loaded scene finds contacts in another order, sums forces in another order, and differs in the
        last digit at first and in everything soon.
        """
        self.bonds.erase_separated()
        self._fresh_bounds()
        self.rock_friction.find_contacts()

    def _fresh_bounds(self):
        # Else, once a body has been erased, a fresh collider would know of no body that an earlier one has known.
        O.bodies.enableRedirection = False
        O.interactions.eraseNonReal()
        # Sorting leaves equal bounds (of facets with a common vertex, of particles in a layer) in the order of the
        # collider's past, and a loaded one has none.
        old = access.yade_engine(InsertionSortCollider)
        fresh = InsertionSortCollider(boundDispatcher=old.boundDispatcher, verletDist=old.verletDist,
                                      avoidSelfInteractionMask=old.avoidSelfInteractionMask, doSort=True,
                                      numAction=old.numAction)
        O.engines = [fresh if isinstance(engine, InsertionSortCollider) else engine for engine in O.engines]
        access.collide_next_step()

    def end_stage(self, folder):
        """Go on to the next stage; `folder` is the run's."""
        self.clock, self.first_iteration = self.time, O.iter
        self.stage += 1

    # ---- what a checkpoint holds

    def state(self):
        """All of ours that a restart needs, beside YADE's scene."""
        return {"stage": self.stage, "first_iteration": self.first_iteration, "clock": self.clock,
                "engines": {engine.name: engine.state() for engine in self.live},
                "last_iteration": {engine.name: engine.last_iteration for engine in self.live}}

    def save(self, directory, folder):
        """Write YADE's scene into `directory` of a checkpoint of the run in `folder`."""
        O.save(str(directory / "scene.yade.gz"))

    def restore(self, state, directory, folder):
        """Go back to a checkpoint: `state`, and YADE's scene in `directory`."""
        O.load(str(directory / "scene.yade.gz"))
        self._make_engines()
        self.stage, self.first_iteration, self.clock = int(state["stage"]), int(state["first_iteration"]), float(state["clock"])
        self._restore_engines(state)
        self._connect()
        for engine in self.live:
            engine.last_iteration = int(state["last_iteration"][engine.name])

    def _restore_engines(self, state):
        for engine in self.live:
            engine.restore(state["engines"].get(engine.name, {}))

    # ---- balances

    def _stored_energy(self):
        """J per metre of thickness, of the rock."""
        return {"kinetic": utils.kineticEnergy(), "elastic": self.bonds.elastic_energy(),
                "contact_elastic": self.rock_friction.elastic_energy()}

    # ---- what a run's folder shows

    def cracks(self):
        """Every bond that broke, as engines.bonds.Crack."""
        return self.bonds.cracks

    def warnings(self):
        """Lines on what in this run's results is not to be relied on."""
        return []

    def write_shape(self, folder):
        """Write the tool's shape, where it may have changed and another run can take it for its own, into the folder."""

    def tables(self):
        """{file: (header, rows)} of further tables: the cracks in order of time."""
        units = "s m m m - - - - J - -".split()
        return {"cracks.csv": ([f"{name} [{unit}]" for name, unit in zip(Crack._fields, units)], sorted(self.cracks()))}

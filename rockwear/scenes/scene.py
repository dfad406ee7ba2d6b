"""The life cycle of every scene: stages of steps, reproducible states, checkpoints."""
from abc import ABC, abstractmethod

from yade import InsertionSortCollider, O, utils

from rockwear.engines import access, base
from rockwear.kernels.checks import require

NEVER = 2**62
"""Steps that no run has."""


class Scene(ABC):
    """A staged simulation with checkpoints at reproducible states (canonical points).

    A scene sets `rock` (a specimen), `time_step` (s) and its stages (`_plan`). `build` fills YADE's scene, and
    `_make_engines` makes `bonds`, `rock_friction`, `recorder` and registers all engines in the order of their visits.
    `output`, a scenes.output.Output, says what the folder of a run shows.
    """

    time_scale = 1.0
    """Seconds of the process in a second of the mechanics [Rojek 2003, 12.1]. All times of a scene but its time step
    are those of the process."""

    def __init__(self):
        self.stage, self.clock, self.engines = 0, 0.0, []
        self.skipped = 0
        """Steps of no length, which no clock and no period counts."""

    @abstractmethod
    def build(self):
        """Fill YADE's scene."""

    @abstractmethod
    def _make_engines(self):
        """Make the engines and register them."""

    def _plan(self, stages):
        """stages: {name: s}. Raises ParameterError for one that is not empty but shorter than half a step."""
        step = self.time_step * self.time_scale
        for name, seconds in stages.items():
            require(seconds == 0 or seconds >= 0.5 * step, name, seconds, f"at least half a step, {0.5 * step:.3g}, "
                    f"with time_step = {self.time_step:.3g} s and time_scale = {self.time_scale:g}", "s")
        # Chunks between canonical points depend on the scene alone, so that every run of it passes the same points.
        self.chunk = int(min(2000, max(100, 12_000_000 // max(1, len(self.rock.pairs)))))
        self.stages = [(name, max(1, self.steps_in(seconds))) for name, seconds in stages.items()]

    def steps_in(self, seconds):
        """Steps in so many seconds of the process."""
        return round(min(seconds / (self.time_step * self.time_scale), NEVER))

    def _register(self, *engines):
        """Make these engines the scene's own; None stands for one that it does not need."""
        self.engines = [engine for engine in engines if engine]
        base.register(self.engines)

    def _insert_engines(self):
        """Insert the engines into YADE's loop, from now on with the scene's time step."""
        O.dt = self.time_step
        base.insert(self.engines)
        self._connect()
        self.first_iteration = O.iter

    def _connect(self):
        for engine in self.engines:
            engine.start_clock()
            engine.connect()

    def skip(self, steps):
        """So many steps of no length have been made."""
        self.skipped += steps
        self.first_iteration += steps
        for engine in self.engines:
            engine.last_iteration += steps

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
        base.run(min(self.chunk, self.stages[self.stage][1] - self.step), self.skipped)
        self.canonical()

    def canonical(self):
        """Bring YADE into the one state that a saved and loaded scene has too: no half-found contacts, fresh bounds.

        Without it a loaded scene finds contacts in another order, sums forces in another order, and differs in the
        last digit at first and in everything soon.
        """
        self.bonds.erase_separated()
        self._refresh_bounds()
        self.rock_friction.find_contacts()

    def _refresh_bounds(self):
        # Else, once a body has been erased, a fresh collider would know of no body that an earlier one has known.
        O.bodies.enableRedirection = False
        O.interactions.eraseNonReal()
        # Sorting leaves equal bounds (of facets with a common vertex, of particles in a layer) in the order of the
        # collider's past, and a loaded one has none.
        old = access.yade_engine(InsertionSortCollider)
        fresh = InsertionSortCollider(boundDispatcher=old.boundDispatcher, verletDist=old.verletDist,
                                      avoidSelfInteractionMask=old.avoidSelfInteractionMask, doSort=True,
                                      numAction=old.numAction)
        access.put_engines([fresh if isinstance(engine, InsertionSortCollider) else engine for engine in O.engines])
        access.collide_next_step()

    def end_stage(self, folder):
        """Go on to the next stage; `folder` is the run's."""
        self.clock, self.first_iteration = self.time, O.iter
        self.stage += 1

    # ---- what a checkpoint holds

    def state(self):
        """All of ours that a restart needs, beside YADE's scene."""
        return {"stage": self.stage, "first_iteration": self.first_iteration, "clock": self.clock,
                "skipped": self.skipped,
                "engines": {engine.name: engine.state() for engine in self.engines},
                "last_iteration": {engine.name: engine.last_iteration for engine in self.engines}}

    def save(self, directory, folder):
        """Write YADE's scene into `directory` of a checkpoint of the run in `folder`."""
        access.save(directory / "scene.yade.gz")

    def restore(self, state, directory, folder):
        """Go back to a checkpoint: `state`, and YADE's scene in `directory`."""
        O.load(str(directory / "scene.yade.gz"))
        self._make_engines()
        self.stage, self.clock = int(state["stage"]), float(state["clock"])
        self.first_iteration, self.skipped = int(state["first_iteration"]), int(state["skipped"])
        self._restore_engines(state)
        self._connect()
        for engine in self.engines:
            engine.last_iteration = int(state["last_iteration"][engine.name])

    def _restore_engines(self, state):
        for engine in self.engines:
            engine.restore(state["engines"].get(engine.name, {}))

    # ---- balances

    def stored_energy(self):
        """{name: J}, per metre of thickness in the plane, that the rock holds."""
        return {"kinetic": utils.kineticEnergy(), "elastic": self.bonds.elastic_energy(),
                "contact_elastic": self.rock_friction.elastic_energy()}

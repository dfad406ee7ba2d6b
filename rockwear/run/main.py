"""A run: reads the parameters, runs the scene with checkpoints, and writes one folder."""
import json
import math
import os
import platform
import resource
import signal
import sys
import time
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import yade

from rockwear import __version__
from rockwear.run import checkpoint, parameters, run_folder, servers, vtk
from rockwear.engines import base
from rockwear.engines.base import RunEnded
from rockwear.engines.history import write_table
from rockwear.kernels.checks import ParameterError, require
from rockwear.kernels.files import naming, replacing, write_arrays
from rockwear.kernels.parameter import Group, Parameter, duration, file, flag, text

COMMON = Group("output", (
    Parameter("out", "", "", text, "folder of the results; out/SCENE when empty, a subfolder a row in a batch"),
    Parameter("resume", False, "", flag, "resume from the checkpoint in the folder"),
    Parameter("checkpoint_interval", 60.0, "s", duration, "wall time between checkpoints"),
    Parameter("snapshot_period", 4e-4, "s", duration, "simulated time between the pictures of the report"),
    Parameter("report", True, "", flag, "write report.html and its figures at the end"),
    Parameter("vtk", False, "", flag, "write each snapshot for ParaView too"),
))
HISTORY = "history.f8"
"""In the folder checkpoint: the rows of history.csv, 8 bytes a number; a checkpoint says how many of them count."""
MOST_STEPS = 1e10
"""In all: more than a month of computing."""
DECISIVE_UNITS = {"N/m", "kg/m3", "m", "m/s", "s"}
"""Units of the parameters that the number of steps depends on."""
BROKEN = OSError, RuntimeError, ArithmeticError, LookupError, ValueError, MemoryError
"""What ends a run with one line: a full disk, YADE, numbers that have become nan or too large."""
NOT_IDENTITY = {"out", "resume", "checkpoint_interval", "report", "vtk"}


def main(name, declared, make_scene):
    """Run the scene `name`. Ends the process.

    declared: Groups, or single Parameters; those of COMMON are added; make_scene(values) -> scene.
    Exit code 0: done; 2: a parameter, a folder or a checkpoint that cannot be used, said in one line before the first
    step; 1: the run ended badly, said in one line, the last checkpoint kept; 128 + n: stopped by signal n, resumable.
    """
    began = time.time()
    servers.close()
    declared = [*declared, COMMON]
    if "--help" in sys.argv:
        parameters.describe(declared)
        _leave(0)
    try:
        values = parameters.read(declared, sys.argv[1:])
        folder, identity = run_folder.find(name, values["out"]), _identity(name, values, declared)
        _check_files(folder, values, declared)
        require(not values["report"] or find_spec("matplotlib"), "report", True,
                "false where Debian's python3-matplotlib is missing")
        if values["resume"]:
            checkpoint.load(folder / "checkpoint", identity)
        scene = make_scene(values)
        _check_steps(scene, values, declared)
        run = Run(name, scene, values, folder, identity, began, parameters.warnings(declared, values))
        run.prepare()
    except ParameterError as error:
        print(f"error: {error}", file=sys.stderr)
        _leave(2)
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        _leave(1)
    except KeyboardInterrupt:
        print("stopped before the first step", file=sys.stderr)
        _leave(128 + signal.SIGINT)
    _leave(run.go())


def _leave(code):
    # What is said may go to a disk that is full.
    with suppress(OSError):
        sys.stdout.flush()
        sys.stderr.flush()
    # YADE's threads make an ordinary exit crash now and then after all work is done.
    os._exit(code)


def _check_steps(scene, values, declared):
    """Raise ParameterError where the scene has too many steps. It names a time step that is given, and what differs
    most from its default."""
    steps = float(sum(steps for _, steps in scene.stages))
    if steps <= MOST_STEPS:
        return
    factors, defaults = {}, parameters.defaults(declared, values)
    for name, parameter in parameters.flat(declared).items():
        value, default = values[name], defaults[name]
        if parameter.unit in DECISIVE_UNITS and isinstance(default, float) and value * default > 0:
            factors[f"{name} = {value:g} {parameter.unit}"] = abs(math.log(value / default))
    if values.get("time_step"):
        factors[f"time_step = {values['time_step']:g} s"] = math.inf
    causes = [cause for cause in sorted(factors, key=factors.get, reverse=True)[:3] if factors[cause] > 1]
    raise ParameterError("steps", steps, f"at most {MOST_STEPS:g} of {scene.time_step:g} s in all: change "
                         + (" or ".join(causes) or "the times of the scene"))


def _files(values, declared):
    """{parameter: Path} of the files that are read."""
    given = {name: p for name, p in parameters.flat(declared).items() if values[name] and (p.rule is file or p.presets)}
    paths = {name: p.presets.path(values[name]) if p.presets else Path(values[name]) for name, p in given.items()}
    return {name: path for name, path in paths.items() if path and path.is_file()}


def _identity(name, values, declared):
    """What a run must share with the checkpoint that it resumes: the contents of its files too."""
    return {"rockwear version": __version__, "YADE version": yade.config.version, "scene": name,
            "parameters": {k: v for k, v in values.items() if k not in NOT_IDENTITY},
            "files": {name: checkpoint.digest(path) for name, path in _files(values, declared).items()}}


def _check_files(folder, values, declared):
    """Raise ParameterError for a file that is read and lies in the folder of the run."""
    for key, path in _files(values, declared).items():
        require(folder.resolve() not in path.resolve().parents, key, str(path),
                f"outside of {folder}, where this run replaces what is there")


class Run:
    """Runs a scene through its stages and writes its folder. said: `parameters.warnings` of its values."""

    def __init__(self, name, scene, values, folder, identity, began, said):
        self.said = said
        self.name, self.scene, self.values, self.folder, self.began = name, scene, values, folder, began
        self.identity = identity
        self.stopped_by = None
        self.snapshots, self.memory, self.ended = 0, [], ""
        self.next_snapshot = 0.0
        self.wall_before = 0.0
        self.setup_time = self.loop_time = self.checkpoint_time = 0.0

    def prepare(self):
        """Make the folder and the scene, fresh or from the checkpoint."""
        if not self.values["resume"]:
            self.scene.build()
        self.lock = run_folder.take(self.folder)
        if self.values["resume"]:
            state, directory = checkpoint.load(self.folder / "checkpoint", self.identity)
            self.scene.restore(state["scene"], directory, self.folder)
            self.snapshots, self.next_snapshot = int(state["snapshots"]), float(state["next_snapshot"])
            self.wall_before, self.ended = float(state["wall_time"]), state["ended"]
            self._remove_later_snapshots()
        else:
            run_folder.empty(self.folder)
            (self.folder / "snapshots").mkdir()
            write_arrays(self.folder / "model.npz", self.scene.output.model())
        (self.folder / "checkpoint").mkdir(exist_ok=True)
        if not self.scene.recorder.history.open(self.folder / "checkpoint" / HISTORY, self.folder / "history.csv"):
            raise checkpoint.CheckpointError(self.folder / "checkpoint", f"whole: {HISTORY} is cut short")
        self.setup_time = time.time() - self.began

    def _remove_later_snapshots(self):
        """Those that the run made between its checkpoint and its end, and now makes again."""
        for shot in (self.folder / "snapshots").glob("*.npz"):
            if int(shot.stem) >= self.snapshots:
                shot.unlink()
        vtk.truncate(self.folder / "vtk", self.snapshots)

    def go(self):
        """Run to the end. -> exit code."""
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._on_signal)
        ended, code = self.ended or "finished", 0
        try:
            if self.values["resume"]:
                # What was written may be later than the checkpoint.
                self._write_tables(self.scene.output.growing_tables())
            else:
                self._checkpoint()
            if not self.ended:
                self._loop()
        except RunEnded as end:
            ended, code = str(end), 0 if end.healthy else 1
        except BROKEN as error:
            ended, code = _line(error), 1
        if self.stopped_by and not code:
            print(f"stopped by signal {self.stopped_by} at t = {self.scene.time:.6g} s; --resume continues from here")
            return 128 + self.stopped_by
        return self._finish(ended, code)

    def _finish(self, ended, code):
        now = f"t = {self.scene.time:.6g} s"
        if code:
            print(f"error: {ended} ({now}; the last checkpoint is kept in {self.folder / 'checkpoint'})",
                  file=sys.stderr)
        elif ended != "finished":
            print(f"{ended} ({now})")
        try:
            with naming(self.folder):
                # A run that had ended before it was resumed has them.
                if not code and not self.ended:
                    self.ended = ended
                    self._snapshot()
                    self._checkpoint()
                warnings = self._warnings()
                self._write_summary(ended, code, warnings)
                self.scene.output.write_shape(self.folder)
                for line in warnings:
                    print(f"warning: {line}", file=sys.stderr)
                if not code and self.values["report"]:
                    # What draws is slow to import, and of no use to a run without a report.
                    from rockwear import report
                    report.write(self.folder)
                    print(f"report: {self.folder / 'report.html'}")
        except BROKEN as error:
            # Of a disk that was full before it has been said.
            if not code:
                print(f"error: {error}", file=sys.stderr)
                # Not a good run, even on a disk too full to say why.
                with suppress(*BROKEN):
                    (self.folder / "summary.json").unlink(missing_ok=True)
                    self._write_summary(_line(error), 1, self._warnings())
            return 1
        return code

    def _warnings(self):
        return [*self.said, *self.scene.output.warnings()]

    def _on_signal(self, number, frame):
        self.stopped_by = number

    def _loop(self):
        last_checkpoint = last_word = time.time()
        self.started, self.steps_here = time.time(), 0
        while not self.scene.finished:
            if self.scene.time >= self.next_snapshot - 0.5 * self.scene.time_step:
                self._snapshot()
            before = self.scene.step
            begin = time.time()
            try:
                self.scene.run_chunk()
            finally:
                self.loop_time += time.time() - begin
            self.steps_here += self.scene.step - before
            if self.scene.stage_done:
                self._snapshot()
                self.scene.end_stage(self.folder)
            now = time.time()
            if self.stopped_by or now - last_checkpoint > self.values["checkpoint_interval"]:
                self._checkpoint()
                last_checkpoint = time.time()
            if self.stopped_by:
                return
            if now - last_word > (1 if sys.stdout.isatty() else 10):
                self._say_progress()
                last_word = now
        self._say_progress()
        if sys.stdout.isatty():
            print()

    def _say_progress(self):
        scene = self.scene
        done = sum(steps for _, steps in scene.stages[:scene.stage]) + (0 if scene.finished else scene.step)
        total = sum(steps for _, steps in scene.stages)
        left = (total - done) / max(self.steps_here, 1) * (time.time() - self.started)
        name = "done" if scene.finished else scene.stages[scene.stage][0]
        line = (f"{name:9s} {100 * done / total:5.1f} %  t = {1e3 * scene.time:.2f} ms  {scene.output.progress()}, "
                f"{int(left) // 60} min {int(left) % 60:02d} s left")
        terminal = sys.stdout.isatty()
        try:
            print(f"\r{line}\033[K" if terminal else line, end="" if terminal else "\n", flush=True)
        except BrokenPipeError:
            # Nobody reads on, as behind `| head`.
            sys.stdout = open(os.devnull, "w", encoding="utf-8")

    def _snapshot(self):
        write_arrays(self.folder / "snapshots" / f"{self.snapshots:04d}.npz", self.scene.output.snapshot())
        if self.values["vtk"]:
            self.scene.output.write_vtk(self.folder / "vtk", self.snapshots)
        self.memory.append((self.scene.time, resident_memory()))
        self.snapshots += 1
        period = self.values["snapshot_period"]
        self.next_snapshot = period * (math.floor(self.scene.time / period + 1e-9) + 1)

    def _checkpoint(self):
        begin = time.time()
        state = {"scene": self.scene.state(), "snapshots": self.snapshots, "next_snapshot": self.next_snapshot,
                 "wall_time": self.wall_before + time.time() - self.began, "ended": self.ended}
        self._write_tables(self.scene.output.growing_tables())
        with naming(self.folder / "checkpoint"):
            checkpoint.save(self.folder / "checkpoint", identity=self.identity, state=state,
                            write_scenes=lambda directory: self.scene.save(directory, self.folder))
        self.checkpoint_time += time.time() - begin

    def _write_tables(self, tables):
        for name, (header, rows) in tables.items():
            write_table(self.folder / name, header, rows)

    def _write_summary(self, ended, code, warnings):
        scene = self.scene
        self._write_tables(scene.output.tables())
        ours = {engine.name: {"seconds": engine.wall_time, "visits": engine.visits} for engine in scene.engines}
        python = sum(engine.wall_time for engine in scene.engines)
        summary = {
            "scene": self.name, "ended": ended, "exit_code": code, "warnings": warnings, "parameters": self.values,
            "files": self.identity["files"], "seed": self.values.get("seed"),
            "versions": {"rockwear": __version__, "yade": yade.config.version, "python": platform.python_version(),
                         "numpy": np.__version__},
            "results": {name: {"value": _plain(value), "unit": unit}
                        for name, (value, unit) in scene.output.results().items()},
            "balances": {name: {"unit": unit, **{key: _plain(value) for key, value in balance.items()}}
                         for name, (balance, unit) in scene.output.balances().items()},
            "wall_time": {"unit": "s", "total": self.wall_before + time.time() - self.began, "set_up": self.setup_time,
                          "loop": self.loop_time, "python_engines": python, "yade": base.yade_time,
                          "checkpoints": self.checkpoint_time, "by_engine": ours},
            # Of this process: a resumed run begins anew.
            "memory": {"unit": "bytes", "time": [time for time, _ in self.memory],
                       "resident": [memory for _, memory in self.memory]},
            "peak_memory": {"value": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024, "unit": "bytes"},
        }
        with replacing(self.folder / "summary.json") as file:
            file.write(json.dumps(summary, indent=1, allow_nan=False).encode())


def resident_memory():
    """Bytes of memory that this process has now."""
    return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1]) * resource.getpagesize()


def _line(error):
    """What ended a run, in one line."""
    return f"{type(error).__name__}: {error}".splitlines()[0]


def _plain(value):
    """The value for JSON, which has no number for one that is not finite."""
    value = value.item() if isinstance(value, np.generic) else value
    return None if isinstance(value, float) and not math.isfinite(value) else value

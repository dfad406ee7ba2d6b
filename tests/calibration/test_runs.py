"""Runs that campaigns, benchmarks and validations start: kept, repeated or failed; their parameters are accepted."""
import itertools
import json
import os
import re
import subprocess
import sys
from concurrent.futures import Future
from types import SimpleNamespace

import numpy as np
import pytest

from calibration import generated
from calibration.benchmarks import __main__ as bench
from calibration.benchmarks import loading_speed, particle_size
from calibration.campaigns import granular, progress, sharp_and_worn, steady_cut_cases, tip_temperature, uniaxial, wear
from calibration.campaigns.runs import RunFailed, Runs, Started, finished, wait_for
from calibration.fitting import rock_fit
from calibration.fitting.rock_unknowns import Micro
from calibration.fitting.rock_targets import Targets
from calibration.fitting.rock_tests import Laboratory
from calibration.validation import __main__ as validation
from rockwear import __version__
from rockwear.run.checkpoint import digest

from tests.running import ROOT, run_script

OWN_COMMAND_LINE = "yade_scripts/two_disc.py", "calibration/benchmarks/stability_runs.py"


def started():
    """(script, {parameter: value}) of every run with parameters of its own."""
    for section in validation.SECTIONS:
        yield from section.runs.values()
    yield from ((script, {**wear.COARSE, **values}) for script, values in wear.CASES.values())
    for values in [*bench.jobs().values(), particle_size.CUT]:
        yield wear.TOOTH, values
    yield steady_cut_cases.SCRIPT, sharp_and_worn.WORN
    for law, targets in (("brittle", {}), ("coulomb", {}), ("cohesive", {"fracture_toughness": 0.9e6})):
        yield from runs_of_a_fit(law, **targets).started[::3]
    for cases, common, _ in uniaxial.CAMPAIGNS.values():
        yield from ((uniaxial.SCRIPT, {**common, **values, "test": "tension"}) for values in cases.values())
    yield from ((uniaxial.SCRIPT, {**uniaxial.SMALL, **values, "speed": loading_speed.SPEEDS[0]})
                for values in uniaxial.ROCKS.values())
    yield from steady_cut_cases.plan(steady_cut_cases.CASES).values()
    yield from ((granular.HEAP, values) for values in granular.heap_values().values())
    yield from ((granular.TUBE, values) for values in granular.tube_values().values())
    for script, values, _ in tip_temperature.SCENES.values():
        yield from ((script, {**values, **tip_temperature.QUICK, **change})
                    for choices in tip_temperature.OPEN.values() for change in choices.values())


class Recorded:
    """In place of Runs: notes what is started."""

    def __init__(self):
        self.started, self.folders = [], []

    def start(self, name, script, **values):
        self.started.append((script, values))
        self.folders.append(name)
        return self

    def result(self, name=None):
        return self if name is None else 1.0


def runs_of_a_fit(law="cohesive", **targets):
    """Recorded: the tests of one step of a rock fit."""
    found = Targets(18e9, 0.18, 60e6, 7e6, points=((6e6, 90e6),), **targets)
    runs, micro = Recorded(), Micro(law=law, targets=found, radius=2.5e-3, given={"porosity": 0.1})
    Laboratory(runs=runs, targets=found, radii=(2e-3, 3e-3), micro=micro).measure(micro.first, rock_fit.SMALL)
    return runs


def test_a_fit_tests_every_packing_once_and_keeps_the_results_apart():
    runs = runs_of_a_fit()
    assert len(runs.folders) == 2 * len(rock_fit.SMALL.seeds) + rock_fit.SMALL.dear == len(set(runs.folders))
    tough = runs_of_a_fit(fracture_toughness=0.9e6).folders
    assert sum("toughness" in folder for folder in tough) == len(rock_fit.SMALL.seeds)
    assert runs_of_a_fit().folders == runs.folders
    assert not set(runs_of_a_fit("coulomb").folders) & set(runs.folders)
    speeds = {values.get("test"): values["speed"] for _, values in runs.started}
    # At half this speed and twice the size, [Rojek 2003]'s bonds (183 MPa, 24.6 GPa) would be loaded at 0.05 m/s.
    assert speeds["compression"] == pytest.approx(2 * 0.05 * (60 / 18000) / (183 / 24600), rel=0.02)
    assert speeds["compression"] > speeds["tension"]
    assert {values["width"] for _, values in runs.started} == {0.109}


class Failing(Recorded):
    """Compression of the first packing, or of all but one, fails."""

    def __init__(self, fewest):
        super().__init__()
        self.fewest = fewest

    def result(self, name=None):
        _, values = self.started.pop(0) if name is None else (None, {})
        if values.get("test") == "compression" and values["seed"] <= self.fewest:
            raise RunFailed(f"packing {values['seed']} ended with 1")
        return super().result(name)


def test_a_packing_that_fails_is_left_out_and_one_alone_is_no_mean():
    targets = Targets(18e9, 0.18, 60e6, 7e6)
    micro = Micro(law="cohesive", targets=targets, radius=1.25e-3, given={})
    one, most = (Laboratory(runs=Failing(count), targets=targets, radii=(1e-3, 1.5e-3), micro=micro)
                 for count in (1, 3))
    found = one.measure(micro.first, rock_fit.SMALL)
    # It keeps its place, so that packings stay with each other.
    assert {o.name: np.isfinite(values).tolist() for o, values in found.items()} == {
        name: [name == "tensile_strength", True, True, True] for name in (
            "youngs_modulus", "poissons_ratio", "ucs", "tensile_strength")}
    assert one.failures == ["packing 1 ended with 1"]
    with pytest.raises(RunFailed, match="youngs_modulus could not be measured on 2 packings of the stage small: pack"):
        most.measure(micro.first, rock_fit.SMALL)


def test_every_run_that_is_started_has_parameters_that_its_scene_takes(tmp_path):
    runs, checks = tmp_path / "runs.json", tmp_path / "checks.json"
    cases = [(str(ROOT / script), values) for script, values in started() if script not in OWN_COMMAND_LINE]
    runs.write_text(json.dumps(cases), encoding="utf-8")
    done = run_script(ROOT / "tests/calibration/scripts/accepted.py", str(runs), str(checks))
    assert done.code == 0, done.stderr
    assert len(cases) > 150 and json.loads(checks.read_text(encoding="utf-8")) == []


def store(folder, values, files=(), version=__version__):
    """The summary of a run that finished."""
    folder.mkdir(exist_ok=True)
    (folder / "summary.json").write_text(json.dumps({
        "exit_code": 0, "versions": {"rockwear": version}, "files": dict(files), "parameters": values}),
        encoding="utf-8")


def test_a_finished_run_is_kept_only_for_the_same_values(tmp_path):
    assert not finished(tmp_path, {})
    store(tmp_path, {"kn": 2e10, "heat": False, "test": "tension"})
    assert finished(tmp_path, {"kn": "2e10", "heat": "false", "test": "tension"})
    assert not finished(tmp_path, {"kn": 1e10}) and not finished(tmp_path, {"kt": 1e10})


def test_a_run_does_not_stand_for_one_with_a_value_less(tmp_path, monkeypatch):
    """Else the results of another rock would be told as those of the default."""
    monkeypatch.setattr(Runs, "submit", lambda self, one: "queued")
    runs = Runs(tmp_path, keep=True)
    assert runs.start("a", "yade_scripts/uniaxial.py", kn=2e10, kt=1e10) == "queued"
    store(tmp_path / "a", {"kn": 2e10, "kt": 1e10})
    assert runs.start("a", "yade_scripts/uniaxial.py", kn=2e10, kt=1e10).folder == tmp_path / "a"
    assert runs.start("a", "yade_scripts/uniaxial.py", kn=2e10) == "queued"


def test_a_finished_run_is_kept_only_for_the_same_files(tmp_path):
    outline = tmp_path / "tooth.csv"
    outline.write_text("0,0", encoding="utf-8")
    given = {"rock": "m_sandstone", "outline": str(outline)}
    files = {"rock": digest(ROOT / "rockwear/rocks/m_sandstone.json"), "outline": digest(outline)}
    store(tmp_path, given, files)
    assert finished(tmp_path, given)
    outline.write_text("0,1", encoding="utf-8")
    assert not finished(tmp_path, given)


def test_a_finished_run_of_another_version_is_repeated(tmp_path):
    store(tmp_path, {"kn": 2e10})
    assert finished(tmp_path, {"kn": 2e10})
    store(tmp_path, {"kn": 2e10}, version="0.1.0")
    assert not finished(tmp_path, {"kn": 2e10})
    (tmp_path / "summary.json").write_text('{"exit_code": 0, "files": {}, "parameters": {}}', encoding="utf-8")
    assert not finished(tmp_path, {})


def test_tables_name_the_versions_of_their_runs_where_one_is_another(tmp_path):
    for name, version in (("a", "0.1.0"), ("b", __version__), ("c", __version__)):
        store(tmp_path / name, {}, version=version)
    page = tmp_path / "page.md"
    text = generated.write_page(page, ["words"])
    assert text == page.read_text(encoding="utf-8") and text.endswith(
        f"\n\n**Runs, by version of rockwear: 1 by 0.1.0, 2 by {__version__}; this is {__version__}.**\n\nwords\n")
    assert "Runs, by" not in generated.write_page(page, ["words"], [tmp_path / "b", tmp_path / "c"])
    assert "1 by 0.1.0;" in generated.write_page(page, ["words"], [tmp_path / "a"])


def test_pages_and_files_name_the_machine(tmp_path, monkeypatch):
    monkeypatch.setattr(generated.os, "getloadavg", lambda: (1.26, 9.0, 9.0))
    monkeypatch.setattr(generated.os, "sched_getaffinity", lambda process: {3, 5})
    cpuinfo = tmp_path / "cpuinfo"
    cpuinfo.write_text("cpu family\t: 6\nmodel\t\t: 85\nmodel name\t: Some  CPU @ 2 GHz\nmodel name\t: Other\n",
                       encoding="utf-8")
    found = generated.machine(cpuinfo)
    assert found == {"processor": "Some CPU @ 2 GHz", "cores": 2, "load": 1.3}
    monkeypatch.setitem(generated.ORIGIN, "machine", found)
    origin = generated.write_page(tmp_path / "page.md", []).replace("\n", " ")
    assert "; Some CPU @ 2 GHz, 2 cores, load 1.3 at the start.*" in origin
    generated.record(tmp_path / "file.png")
    manifest = json.loads((tmp_path / "provenance.json").read_text(encoding="utf-8"))
    assert manifest["file.png"]["machine"] == found


def test_what_a_machine_does_not_tell_is_left_out(tmp_path, monkeypatch):
    def unknown(*_):
        raise OSError

    monkeypatch.setattr(generated.os, "getloadavg", unknown)
    monkeypatch.setattr(generated.os, "sched_getaffinity", lambda process: {3})
    assert generated.machine_words(generated.machine(tmp_path / "nowhere")) == "1 core"
    (tmp_path / "other").write_text("Processor\t: a name of another kind\n", encoding="utf-8")
    monkeypatch.delattr(generated.os, "sched_getaffinity")
    assert generated.machine(tmp_path / "other") == {} and generated.machine_words({}) == "unknown machine"


def test_campaigns_say_how_their_runs_stand_and_what_ends_first_first(tmp_path, monkeypatch, capsys):
    runs = {name: Started(tmp_path / name, Future(), tmp_path / f"{name}.log") for name in ("slow", "bad", "fast")}
    runs["kept"] = Started(tmp_path / "kept")
    for folder in ("slow", "fast", "kept"):
        store(tmp_path / folder, {})
    for name, part in (("slow", "50.0"), ("bad", "10.0")):
        runs[name].log.write_text(f"cut  1.0 %  t = 0\ncut  {part} %  t = 1 ms  1 min left\n", encoding="utf-8")
    endings = iter([("fast", (0, "")), ("bad", (1, "error: k")), ("slow", (0, ""))])

    def end_next(left, timeout):
        name, ending = next(endings)
        runs[name].future.set_result(ending)

    monkeypatch.setattr("calibration.campaigns.runs._wait_for_next", end_next)
    monkeypatch.setattr(progress, "time", SimpleNamespace(time=itertools.count(0, 100).__next__))
    assert wait_for(runs, lambda key, run: key) == 1
    said, failed = capsys.readouterr()
    assert failed == "bad ended with 1: error: k\n"
    lines = said.splitlines()
    assert lines[1].endswith(", time left not known yet") and re.search(r", \d+ min \d+ s left$", lines[3])
    assert [line.split(" %")[0] for line in lines] == [
        "kept", "1 of 4 runs done, 0 failed, 40.0", "fast", "2 of 4 runs done, 0 failed, 65.0",
        "2 of 4 runs done, 1 failed, 87.5", "slow", "3 of 4 runs done, 1 failed, 100.0"]


def test_a_campaign_whose_runs_are_all_kept_says_nothing_of_time(tmp_path, capsys):
    store(tmp_path / "kept", {})
    assert wait_for({"kept": Started(tmp_path / "kept")}, lambda key, run: key) == 0
    assert capsys.readouterr().out == "kept\n"


def test_a_run_that_fails_says_so(tmp_path):
    with Runs(tmp_path) as runs, pytest.raises(RunFailed, match="bad ended with 2: error: sped = 1"):
        runs.start("bad", "yade_scripts/uniaxial.py", sped=1).result()


@pytest.mark.parametrize("campaign, words", [
    ("sharp_and_worn", []), ("tip_temperature", []), ("granular", ["DIR", "--read"]), ("library", []),
    ("steady_cut", ["DIR", "no such case"]), ("wear", ["DIR", "ripper, 9"])])
def test_a_campaign_without_a_folder_or_of_unknown_cases_is_refused_in_one_line(campaign, words, tmp_path):
    command = [sys.executable, "-m", f"calibration.campaigns.{campaign}", *words]
    done = subprocess.run(command, cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True,
                          encoding="utf-8")
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert done.stderr.startswith(f"usage: python3 -m calibration.campaigns.{campaign} DIR ")
    assert not list(tmp_path.iterdir())

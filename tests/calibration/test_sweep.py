"""Sweeps of a table: a worker killed in mid-row, failed and finished rows, bad input, the page, a job array."""
import csv
import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

import numpy as np
import pytest

from calibration.campaigns import runs, yade_job
from calibration.sweep import __main__ as sweep
from calibration.sweep import page, slurm
from rockwear import __version__
from tests.running import ROOT

SCRIPT = str(ROOT / "yade_scripts/uniaxial.py")
ROW = dict(test="tension", width=0.04, height=0.03, radius_min=1e-3, radius_max=1.5e-3, kt=4e9, Rt=1e5, speed=0.03,
           checkpoint_interval=0.01, report="false")
"""Some 200 discs pulled apart in a chunk of 2000 steps and a part of one, each followed by a checkpoint."""
PARENT = re.compile(r"\) \w (\d+) ")


def table(path, header, *rows):
    path.write_text("\n".join(["# a sweep", header, *rows]) + "\n", encoding="utf-8")
    return str(path)


def process_of(folder):
    """Id of the YADE process that writes `folder`."""
    for entry in Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and str(folder) in (entry / "cmdline").read_text(encoding="utf-8").split("\0"):
                return int(entry.name)
        except OSError:
            continue
    return None


def kill_worker(folder, found):
    """Kill the worker of the row in `folder` once its second chunk has a row; note what there is then, and how long
    YADE ran on."""
    current = folder / "checkpoint/current.json"
    deadline = time.time() + 60
    while time.time() < deadline and not (current.exists() and json.loads(
            current.read_text(encoding="utf-8"))["set"] > 1):
        time.sleep(0.01)
    size = (folder / "history.csv").stat().st_size
    while time.time() < deadline and (folder / "history.csv").stat().st_size == size:
        time.sleep(0.01)
    child = process_of(folder)
    worker = int(PARENT.search(Path(f"/proc/{child}/stat").read_text(encoding="utf-8"))[1])
    killed = time.time()
    os.kill(worker, signal.SIGKILL)
    while process_of(folder) == child and time.time() < deadline:
        time.sleep(0.01)
    found["orphan"], found["set"] = time.time() - killed, json.loads(current.read_text(encoding="utf-8"))["set"]
    with np.load(folder / f"checkpoint/{found['set']}/state.npz") as state:
        found["saved rows"] = int(state["scene/engines/recorder/rows"])
    found["history"] = (folder / "history.csv").read_bytes()
    found["cracks"] = (folder / "cracks.csv").read_bytes()


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """(folder, exit code, notes, rows) of a sweep of two equal rows, the worker of the first killed, and one that
    fails."""
    folder = tmp_path_factory.mktemp("sweep")
    words = table(folder / "rows.table", "description seed " + " ".join(ROW) + " !OMP_NUM_THREADS",
                  "killed 1 " + " ".join(map(str, ROW.values())) + " 1", "never" + " =" * (len(ROW) + 2),
                  "impossible 2 " + " ".join(map(str, {**ROW, "width": 1e-3}.values())) + " -")
    out, notes = folder / "out", {}
    killer = threading.Thread(target=kill_worker, args=(out / "killed", notes))
    killer.start()
    with mock.patch.object(sweep, "read_rows", wraps=sweep.read_rows) as reader:
        rows = []
        reader.side_effect = lambda *given: rows.append(reader._mock_wraps(*given)) or rows[0]
        code = sweep.main([words, SCRIPT, "--out", str(out)])
    killer.join()
    return out, code, notes, rows[0][0]


def test_a_row_whose_worker_is_killed_goes_on_elsewhere_and_differs_in_no_bit(swept):
    out, code, notes, _ = swept
    killed, never = (json.loads((out / name / "summary.json").read_text(encoding="utf-8")) for name in (
        "killed", "never"))
    assert code == 1 and notes["set"] == 2 and notes["orphan"] < 1
    assert killed["parameters"]["resume"] and not never["parameters"]["resume"]
    assert killed["results"] == never["results"] and killed["balances"] == never["balances"]
    assert (out / "killed/history.csv").read_bytes() == (out / "never/history.csv").read_bytes()


def test_a_killed_run_has_its_rows_so_far_on_the_disk(swept):
    out, _, notes, _ = swept
    assert (out / "never/history.csv").read_bytes().startswith(notes["history"])
    assert (out / "never/cracks.csv").read_bytes().startswith(notes["cracks"]) and notes["cracks"].endswith(b"\n")
    # Of the chunk that was under way, too.
    assert notes["history"].endswith(b"\n") and notes["history"].count(b"\n") > 1 + notes["saved rows"] > 100


def test_failed_rows_are_told_apart_and_gathered_with_the_others(swept):
    out, _, _, _ = swept
    page = (out / "sweep.html").read_text(encoding="utf-8")
    assert "2 of 3 rows done" in page
    assert "impossible ended with 2: error: radius_max = 0.0015 m" in page
    rows = list(csv.DictReader((out / "sweep.csv").read_text(encoding="utf-8").splitlines()))
    assert [row["row"] for row in rows] == ["killed", "never"]
    assert float(rows[0]["youngs_modulus [Pa]"]) > 1e9 and (out / "width.png").exists() is False


def test_finished_rows_are_kept(swept, monkeypatch):
    out, _, _, rows = swept
    assert [row.done for row in rows] == [True, True, False]
    monkeypatch.setattr(runs.Runs, "_connect", None)
    sweep.run_all(rows[:2], out)
    assert not replace(rows[0], values={**rows[0].values, "kn": 1.0}).done


@pytest.fixture
def cluster(tmp_path):
    """(address of a dask scheduler, file with a line for each run of YADE) of a worker that knows nothing of ours."""
    programs, file, ran = tmp_path / "programs", tmp_path / "scheduler.json", tmp_path / "ran"
    programs.mkdir()
    yade = programs / "yade"
    yade.write_text(f'#!/bin/sh\necho run >> "{ran}"\nexec {shutil.which("yade")} "$@"\n', encoding="utf-8")
    yade.chmod(0o755)
    environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"}
    environment.pop("PYTHONPATH", None)
    options = dict(cwd=programs, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    own = ["--host", "127.0.0.1", "--no-dashboard"]
    started = [subprocess.Popen(["dask-scheduler", *own, "--port", "0", "--scheduler-file", str(file)], **options),
               subprocess.Popen(["dask-worker", *own, "--no-nanny", "--nthreads", "2", "--scheduler-file", str(file),
                                 "--local-directory", str(programs)], **options)]
    deadline = time.time() + 120
    while not file.exists() and time.time() < deadline:
        time.sleep(0.1)
    yield json.loads(file.read_text(encoding="utf-8"))["address"], ran
    for process in reversed(started):
        process.terminate()
        process.wait(60)


@pytest.mark.skipif(not (shutil.which("dask-scheduler") and shutil.which("dask-worker")), reason="no commands of dask")
def test_a_sweep_runs_on_the_worker_of_a_scheduler(cluster, tmp_path):
    address, ran = cluster
    assert address.startswith("tcp://127.0.0.1:")
    words = table(tmp_path / "rows.table", "description seed " + " ".join(ROW),
                  *(f"row{seed} {seed} " + " ".join(map(str, ROW.values())) for seed in (1, 2)))
    done = subprocess.run(
        [sys.executable, "-m", "calibration.sweep", words, SCRIPT, "--out", str(tmp_path / "out"), "--scheduler",
         address], cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, encoding="utf-8")
    assert done.returncode == 0 and "2 of 2 rows are done, 0 failed" in done.stdout, done.stdout + done.stderr
    assert "2 of 2 runs done, 0 failed, 100.0 %" in done.stdout
    for seed in (1, 2):
        assert json.loads((tmp_path / f"out/row{seed}/summary.json").read_text(encoding="utf-8"))["seed"] == seed
    assert len(ran.read_text(encoding="utf-8").splitlines()) == 2


@pytest.mark.parametrize("header, row, line", [
    ("description sped", "a 1", "sped = 1: must be a known parameter; did you mean speed (--help lists them) "
     "(line 3)"),
    ("description seed", "a 1\na 2", "description = a: must be different from that of line 3"),
    ("description seed", "a 1 2 3", "bad.table: must be a table of yade-batch: a header, then a cell a column"),
    ("description seed", "a", "bad.table: must be a table of yade-batch: a header, then a cell a column"),
    ("seed kn speed seed", "1 2e9 1 3", "bad.table, column seed: must be there once")])
def test_bad_tables_are_refused_before_a_row_runs(tmp_path, capsys, header, row, line):
    assert sweep.main([table(tmp_path / "bad.table", header, row), SCRIPT, "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert said.startswith("error: ") and line in said and len(said.splitlines()) == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("cells, folder", [(("-", "-"), "out/rows"), (("a", "a"), "a"), (("a", "-"), "out/rows")])
def test_the_folder_is_that_of_all_rows_or_named_by_the_table(tmp_path, monkeypatch, cells, folder):
    monkeypatch.chdir(tmp_path)
    words = table(tmp_path / "rows.table", "seed out", *(f"{seed} {cell}" for seed, cell in enumerate(cells)))
    rows, _, found = sweep.read_rows(words, SCRIPT, "")
    assert str(found) == folder and [row.given for row in rows] == [{"seed": "0"}, {"seed": "1"}]


def test_a_row_that_is_not_there_is_refused(tmp_path, capsys):
    words = table(tmp_path / "rows.table", "description seed", "a 1", "b 2")
    assert sweep.main([words, SCRIPT, "--out", str(tmp_path / "out"), "--row", "9"]) == 2
    assert capsys.readouterr().err == "error: row = 9: must be from 1 to 2\n" and not (tmp_path / "out").exists()


def test_a_missing_table_and_a_silent_scheduler_are_refused(tmp_path, capsys, monkeypatch):
    assert sweep.main([str(tmp_path / "none.table"), SCRIPT]) == 2
    monkeypatch.setattr(runs, "PATIENCE", 0.2)
    with pytest.raises(SystemExit) as ended:
        runs.placement(["--scheduler", "tcp://127.0.0.1:1"])
    said = capsys.readouterr().err.splitlines()
    assert ended.value.code == 2 and len(said) == 2 and said[1].startswith("error: scheduler = tcp://127.0.0.1:1: must")


def job(folder, words):
    """A job that says which words it was given, and does as told."""
    return {"command": ["sh", "-c", words, "sh"], "folder": str(folder), "log": f"{folder}.log",
            "directory": str(folder.parent), "environment": {}}


@pytest.mark.parametrize("words, code, said", [
    ("echo one; echo 'error: k = 1' >&2; echo; exit 2", 2, "error: k = 1"), ("echo last; exit 1", 1, "last"),
    ("kill -9 $$", -9, "nothing said"), ("echo $1", 0, "--resume"),
    ("[ -z $1 ] || { echo 'error: checkpoint = of another run'; exit 2; }; echo anew", 0, "anew")])
def test_a_job_tells_how_it_ended_and_resumes_what_fits(tmp_path, words, code, said):
    (tmp_path / "row/checkpoint").mkdir(parents=True)
    (tmp_path / "row/checkpoint/current.json").write_text("{}", encoding="utf-8")
    assert yade_job.run(job(tmp_path / "row", words)) == (code, said)


def test_a_job_tells_why_it_could_not_begin(tmp_path):
    (tmp_path / "file").touch()
    code, said = yade_job.run(job(tmp_path / "file/row", "exit 0"))
    assert code == 1 and said.startswith("error: ") and "file" in said


def test_a_job_that_is_no_longer_wanted_is_stopped(tmp_path):
    begin = time.time()
    code, _ = yade_job.run(job(tmp_path / "row", "sleep 60"), lambda: time.time() > begin + 0.1)
    assert code == -signal.SIGTERM and time.time() < begin + 5


def test_a_job_waits_for_whoever_writes_its_folder(tmp_path):
    (tmp_path / "row").mkdir()
    holder = subprocess.Popen(["flock", str(tmp_path / "row/lock"), "sleep", "0.5"])
    begin = time.time()
    while not yade_job._is_locked(tmp_path / "row"):
        time.sleep(0.01)
    assert yade_job.run(job(tmp_path / "row", "exit 0")) == (0, "nothing said")
    assert time.time() > begin + 0.4 and holder.wait() == 0


def start_by_slurm(file, task, spool, **environment):
    """Start a job of an array as Slurm 22.05 does: a copy of the script, in a session of its own, which appends to the
    log. spool: stands for the folders of slurmd and of sbatch. -> (process, log)"""
    options = dict(shlex.split(line.removeprefix("#SBATCH "))[0].removeprefix("--").partition("=")[::2]
                   for line in file.read_text(encoding="utf-8").splitlines() if line.startswith("#SBATCH "))
    assert options["signal"] == "B:USR1@120" and options["open-mode"] == "append" and "requeue" in options
    log = Path(re.sub("%(.)", lambda found: {"%": "%", "a": str(task)}[found[1]], options["output"]))
    script = spool / "job00009/slurm_script"
    script.parent.mkdir(parents=True)
    shutil.copyfile(file, script)
    script.chmod(0o700)
    with open(log, "a", encoding="utf-8") as words:
        return subprocess.Popen([script], cwd=spool, stdin=subprocess.DEVNULL, stdout=words, stderr=words, env={
            **os.environ, "SLURM_JOB_ID": "9", "SLURM_ARRAY_JOB_ID": "7", "SLURM_ARRAY_TASK_ID": str(task),
            **environment}, start_new_session=True), log


def wait_for(file):
    """Wait until a file exists."""
    deadline = time.time() + 120
    while not file.exists() and time.time() < deadline:
        time.sleep(0.02)


def test_a_job_array_runs_a_row_and_its_failure_is_gathered(swept, tmp_path, monkeypatch, capsys):
    out, _, _, _ = swept
    words = [str(out.parent / "rows.table"), SCRIPT, "--out", str(out)]
    file = out / "array.sh"
    assert sweep.main([*words, "--slurm", str(file)]) == 0
    assert "#SBATCH --array=1-3\n" in file.read_text(encoding="utf-8")
    process, log = start_by_slurm(file, 3, tmp_path)
    assert process.wait(120) == 1 and log == out / "slurm-3.log"
    line = "failed: impossible ended with 2: error: radius_max = 0.0015 m"
    assert log.read_text(encoding="utf-8").startswith(line)
    monkeypatch.setattr(runs.Runs, "_connect", None)
    capsys.readouterr()
    (out / "sweep.html").unlink()
    assert sweep.main([*words, "--read"]) == 1
    said = capsys.readouterr()
    assert said.err.startswith(line) and said.out.startswith("2 of 3 rows are done, 1 failed: ")
    assert line.removeprefix("failed: ") in (out / "sweep.html").read_text(encoding="utf-8")


def test_rows_that_have_not_ended_are_gathered_as_such(swept, tmp_path, capsys):
    out, _, _, _ = swept
    shutil.copytree(out / "never", tmp_path / "never")
    (tmp_path / "killed.log").write_text("failed: before\nanother run\n", encoding="utf-8")
    assert sweep.main([str(out.parent / "rows.table"), SCRIPT, "--out", str(tmp_path), "--read"]) == 1
    said = capsys.readouterr()
    assert not said.err and said.out.startswith("1 of 3 rows are done, 0 failed: ")
    assert (tmp_path / "sweep.html").read_text(encoding="utf-8").count("not done") == 2


@pytest.mark.parametrize("number, requeued", [(signal.SIGUSR1, ["7_2 checkpoint"]), (signal.SIGTERM, []), (None, [])])
def test_a_job_is_queued_again_at_its_time_limit_alone(tmp_path, monkeypatch, number, requeued):
    """A row that waits for SIGTERM, writes its checkpoint and ends as a row does, or that fails with a code as high."""
    folder = tmp_path / "a folder, 50 %"
    folder.mkdir()
    row, file = folder / "row", folder / "array.sh"
    row.write_text("#!/bin/bash\ntrap 'sleep 0.5; touch checkpoint; exit 143' TERM\ntouch begun\n" + (
        "exit 143" if number is None else "while :; do sleep 0.05; done") + "\n", encoding="utf-8")
    (folder / "scontrol").write_text('#!/bin/bash\necho "$2" checkpoin* > requeued\n', encoding="utf-8")
    for program in (row, folder / "scontrol"):
        program.chmod(0o755)
    monkeypatch.chdir(folder)
    monkeypatch.setattr(slurm.sys, "executable", str(row))
    assert slurm.write(file, [SimpleNamespace(threads=2)], "rows.table", SCRIPT, folder) == 0
    process, log = start_by_slurm(file, 2, tmp_path / "spool", PATH=f"{folder}:{os.environ['PATH']}")
    assert log == folder / "slurm-2.log"
    wait_for(folder / "begun")
    if number == signal.SIGTERM:
        os.killpg(process.pid, number)
    elif number:
        process.send_signal(number)
    assert process.wait(60) == 143 and (folder / "checkpoint").exists() == bool(number)
    assert [file.read_text(encoding="utf-8").strip() for file in folder.glob("requeued")] == requeued


def test_a_cancelled_job_ends_once_its_run_has_written_its_checkpoint(tmp_path, monkeypatch):
    """scancel signals all processes of a job at once, and the script the row's once more."""
    yade = tmp_path / "yade"
    yade.write_text(f"""#!/bin/bash
case "$*" in *" --out "*) ;; *) exec {shutil.which("yade")} "$@";; esac
trap 'sleep 1; touch {tmp_path}/checkpoint; exit 143' TERM
touch {tmp_path}/begun
while :; do sleep 0.05; done
""", encoding="utf-8")
    yade.chmod(0o755)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    words = table(tmp_path / "rows.table", "description seed", "a 1")
    assert sweep.main([words, SCRIPT, "--out", "out", "--slurm", "array.sh"]) == 0
    process, log = start_by_slurm(tmp_path / "array.sh", 1, tmp_path / "spool")
    wait_for(tmp_path / "begun")
    os.killpg(process.pid, signal.SIGTERM)
    assert process.wait(60) == 143 and (tmp_path / "checkpoint").exists()
    assert log.read_text(encoding="utf-8").count("stopped by signal 15") == 1


def made_up(folder, given, values):
    """A row that has finished, in a subfolder of `folder` of its own."""
    place = folder / f"row {len(list(folder.iterdir()))}"
    place.mkdir()
    (place / "report.html").write_text("", encoding="utf-8")
    (place / "summary.json").write_text(json.dumps({
        "exit_code": 0, "versions": {"rockwear": __version__},
        "files": {}, "parameters": values, "wall_time": {"total": 60}, "results": {
            "mean_cutting_force": {"value": 1e6 * values["depth"], "unit": "N/m"}, "same": {"value": 1.0, "unit": "-"},
            "name": {"value": "none", "unit": "-"}}}), encoding="utf-8")
    return sweep.Row(place.name, given, values, 1, place, {})


def test_the_page_draws_each_swept_parameter_and_links_the_reports(tmp_path, capsys):
    rows = [made_up(tmp_path, {"depth": "", "kind": ""}, {"depth": depth, "kind": kind, "kn": 1e9})
            for depth, kind in [(1e-3, "sharp"), (2e-3, "sharp"), (1e-3, "worn"), (2e-3, "worn")]]
    text = page.write(tmp_path, rows, {"depth": "m", "kind": "", "kn": "N/m"}).read_text(encoding="utf-8")
    assert "4 of 4 rows done" in text and text.count("<img") == 2 and 'href="row%202/report.html"' in text
    assert "<td class=\"number\">2 mm</td>" in text and "2 kN/m" in text and "<th>same" not in text
    page.write(tmp_path, rows, {"depth": "m"}, ["same", "nosuch"])
    assert capsys.readouterr().err == "no row has a result nosuch\n"
    for name in ("depth", "kind"):
        assert (tmp_path / f"{name}.png").stat().st_size > 5000


def test_figures_have_the_unit_of_a_result_that_the_first_row_lacks(tmp_path):
    rows = [made_up(tmp_path, {"depth": ""}, {"depth": depth}) for depth in (1e-3, 2e-3, 3e-3)]
    found = {row.name: row.run_folder() for row in rows}
    for k, row in enumerate(rows[1:]):
        found[row.name].summary["results"]["tool_temperature_max"] = {"value": 296.15 + 1e-6 * k, "unit": "K"}
    figure = page.draw("depth", rows, found, ["depth"], {"depth": "m"}, ["tool_temperature_max"])
    axes, = (axes for axes in figure.axes if axes.lines)
    assert axes.get_ylabel().endswith("°C") and axes.lines[0].get_ydata()[1] == pytest.approx(23.0)
    assert not axes.yaxis.get_major_formatter().get_useOffset()


def test_a_row_that_failed_is_none_that_is_done(tmp_path, monkeypatch, capsys):
    """Its worker was lost once its run had ended."""
    rows = [made_up(tmp_path, {"depth": ""}, {"depth": depth}) for depth in (1e-3, 2e-3)]
    rows[0].failure = "row 0 was given up"
    monkeypatch.setattr(sweep, "read_rows", lambda *given: (rows, {"depth": "m"}, tmp_path))
    monkeypatch.setattr(sweep, "run_all", lambda rows, folder: None)
    assert sweep.main(["some.table", SCRIPT]) == 1
    assert "2 of 2 rows are done, 1 failed: " in capsys.readouterr().out


def test_a_row_that_leaves_a_parameter_out_is_told_apart_from_those_that_give_it(tmp_path):
    """By its default, as a value like the others."""
    rows = [made_up(tmp_path, given, {"depth": depth, "kn": kn})
            for given, depth, kn in (({"kn": ""}, 1e-3, 2e9), ({}, 2e-3, 1e9))]
    text = page.write(tmp_path, rows, {"depth": "m", "kn": "N/m"}).read_text(encoding="utf-8")
    assert "<th>kn" in text and "<th>depth" not in text and (tmp_path / "kn.png").exists()
    found = list(csv.DictReader((tmp_path / "sweep.csv").read_text(encoding="utf-8").splitlines()))
    assert [float(row["kn [N/m]"]) for row in found] == [2e9, 1e9]

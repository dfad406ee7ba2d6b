"""What a run does around its scene, seen from outside of its process."""
import os
import signal
import subprocess

import pytest

from rockwear.run import checkpoint, lock
from tests.running import ROOT, arguments, run_script, start

SCRIPTS = ROOT / "tests/run/scripts"


def error_of(run):
    """The one line that a run without a traceback ends with."""
    assert run.code == 2 and "Traceback" not in run.stderr, run.stderr
    return run.stderr.splitlines()[-1]


def test_a_run_listens_on_no_port(tmp_path):
    assert error_of(run_script(SCRIPTS / "ports.py", cwd=tmp_path)) == "error: ports = []: must be listed"


def test_a_run_interrupted_while_its_scene_is_made_says_so_and_leaves_nothing(tmp_path):
    run = run_script(SCRIPTS / "interrupted.py", cwd=tmp_path)
    assert run.code == 128 + signal.SIGINT and run.stderr.splitlines()[-1] == "stopped before the first step"
    assert "Traceback" not in run.stderr and not list(tmp_path.iterdir())


def test_a_batch_keeps_the_servers_that_its_overview_asks(tmp_path):
    table = tmp_path / "table.txt"
    table.write_text("out\nhere\n", encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "YADE_BATCH": f"{table}:2"}
    words = error_of(run_script(SCRIPTS / "ports.py", cwd=tmp_path, env=environment))
    ports = [int(word) for word in words.partition("[")[2].partition("]")[0].split(",")]
    assert len(ports) == 2 and min(ports) >= 9000


@pytest.mark.parametrize("words, named", [
    (["--k", "1e29"], "change k = 1e+29 N/m"),
    (["--density", "1e-30", "--width", "1.5"], "change density = 1e-30 kg/m3"),
    (["--time", "1e8", "--k=1e15"], "change k = 1e+15 N/m or time = 1e+08 s"),
    (["--time", "1e8", "--stiff"], "change time = 1e+08 s"),
    (["--stiff", "--k", "1e29"], "change k = 1e+29 N/m"),
    (["--time_step", "1e-15", "--k", "1e8"], "change time_step = 1e-15 s or k = 1e+08 N/m")])
def test_too_many_steps_name_what_makes_them(words, named, tmp_path):
    error = error_of(run_script(SCRIPTS / "steps.py", *words, cwd=tmp_path))
    assert error.startswith("error: steps = ") and error.endswith(named)
    assert os.listdir(tmp_path) == []


def test_a_row_of_a_table_may_leave_a_column_out(tmp_path):
    table = tmp_path / "table.txt"
    table.write_text("k density\n1e29 -\n- 1e-30\n", encoding="utf-8")
    for line, cause in ((2, "k = 1e+29 N/m"), (3, "density = 1e-30 kg/m3")):
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "YADE_BATCH": f"{table}:{line}"}
        assert error_of(run_script(SCRIPTS / "steps.py", cwd=tmp_path, env=environment)).endswith(f"change {cause}")


@pytest.mark.parametrize("text, rule", [
    ("k density k!\n1 1e3 2\n", "table.txt, column k: must be there once"),
    ("\ufeffk density\n1 1e3\n", "table.txt: must be without a byte order mark"),
    ("\ufeff# springs\nk density\n1 1e3\n", "table.txt: must be without a byte order mark")])
def test_a_table_that_yade_reads_in_another_way_is_refused(text, rule, tmp_path):
    table = tmp_path / "table.txt"
    table.write_text(text, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "YADE_BATCH": f"{table}:{text.count(chr(10))}"}
    error = error_of(run_script(SCRIPTS / "steps.py", cwd=tmp_path, env=environment))
    assert error == f"error: table = {tmp_path}/{rule}"


def test_a_checkpoint_of_another_version_is_refused(tmp_path):
    checkpoint.save(tmp_path / "out/checkpoint", identity={"rockwear version": "0.1.0"}, state={},
                    write_scenes=lambda directory: None)
    (tmp_path / "out" / lock.FILE).touch()
    error = error_of(run_script(SCRIPTS / "steps.py", "--out", str(tmp_path / "out"), "--resume"))
    assert "must be of the same rockwear version: 0.1.0 there, " in error


def test_help_shows_the_groups(tmp_path):
    run = run_script(SCRIPTS / "steps.py", "--help", cwd=tmp_path)
    assert run.code == 0
    sections = {block.splitlines()[0]: block for block in run.stdout.split("\n\n")}
    assert "--density kg/m3" in sections["oscillator:"] and "(default 1000 kg/m3; ours)" in sections["oscillator:"]
    assert "--out TEXT" in sections["output:"]


def test_a_run_without_its_report_is_not_done_until_it_is_resumed(tmp_path):
    """A file stands where the folder of the figures is to be."""
    words = arguments(dict(test="tension", width=0.04, height=0.03, radius_min=1e-3, radius_max=1.5e-3, kt=4e9, Rt=1e5,
                           speed=0.03, out=tmp_path))
    for name in (lock.FILE, "figures"):
        (tmp_path / name).touch()
    run = run_script(ROOT / "yade_scripts/uniaxial.py", *words, out=tmp_path)
    assert run.code == 1 == run.summary["exit_code"] and run.stderr.splitlines()[-1].startswith("error: ")
    assert run.summary["ended"].startswith("FileExistsError: ") and "figures" in run.summary["ended"]
    (tmp_path / "figures").unlink()
    run = run_script(ROOT / "yade_scripts/uniaxial.py", *words, "--resume", out=tmp_path)
    assert run.code == 0 == run.summary["exit_code"] and run.summary["ended"].startswith("failed at ")
    assert (tmp_path / "report.html").exists()


def test_a_run_that_nobody_reads_any_more_goes_on_to_its_end(tmp_path):
    """As behind `| head -4`: its pipe is closed."""
    process = start(ROOT / "yade_scripts/sliding_wear.py", ["--report", "false", "--out", str(tmp_path / "out")],
                    stderr=subprocess.DEVNULL)
    # YADE itself, which speaks before, would not survive.
    assert any("XMLRPC" in line for line in iter(process.stdout.readline, ""))
    process.stdout.close()
    assert process.wait(120) == 0 and (tmp_path / "out/summary.json").exists()

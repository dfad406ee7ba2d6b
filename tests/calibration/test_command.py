"""Command lines of all commands of calibration: help and unknown options, before anything is made."""
import ast
import importlib.util
import os
import re
import runpy
import subprocess
import sys

import pytest

from calibration.campaigns.runs import Runs
from tests.running import ROOT

OTHER = re.compile(r"^(?:from yade|import yade|import Kratos|from rockwear\.run\.main)|parameters\.read\(.*sys\.argv",
                   re.MULTILINE)
COMMANDS = sorted(".".join(file.relative_to(ROOT).with_suffix("").parts).removesuffix(".__main__")
                  for file in (ROOT / "calibration").rglob("*.py")
                  if '\nif __name__ == "__main__":' in (text := file.read_text(encoding="utf-8"))
                  and not OTHER.search(text))
"""Modules that python3 -m runs; the others are scripts of YADE or of a peer's environment."""
FIT = "calibration.fit"
"""Lists its parameters in place of its docstring."""


@pytest.fixture
def run(tmp_path, monkeypatch, capsys):
    """run(command, word, ...) -> (exit code, stdout, stderr), in an empty folder, where no run can start."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(Runs, "_connect", None)

    def of(command, *words):
        monkeypatch.setattr(sys, "argv", [command, *words])
        with pytest.raises(SystemExit) as ended:
            runpy.run_module(command, run_name="__main__", alter_sys=True)
        assert not list(tmp_path.iterdir())
        return ended.value.code, *capsys.readouterr()

    return of


def documented(command):
    """Docstring of a command's module."""
    found = importlib.util.find_spec(command)
    name = f"{command}.__main__" if found.submodule_search_locations else command
    return ast.get_docstring(ast.parse(importlib.util.find_spec(name).loader.get_source(name)))


def test_a_part_of_an_option_is_not_the_option(run):
    code, _, wrong = run("calibration.sweep", "some.table", "script.py", "--job", "7")
    assert code == 2 and "--job" in wrong and wrong.count("\n") == 1


def test_all_commands_are_found():
    assert len(COMMANDS) > 20 and {"calibration.sweep", "calibration.campaigns.library"} <= set(COMMANDS)


@pytest.mark.filterwarnings("ignore:.*found in sys.modules:RuntimeWarning")
@pytest.mark.parametrize("command", COMMANDS)
def test_help_is_said_and_nothing_is_made(run, command):
    code, said, wrong = run(command, "--help")
    assert code == 0 and not wrong and f"python3 -m {command} " in said
    assert command == FIT or documented(command).splitlines()[0] in said


@pytest.mark.filterwarnings("ignore:.*found in sys.modules:RuntimeWarning")
@pytest.mark.parametrize("command", COMMANDS)
def test_an_unknown_option_is_refused_in_one_line(run, command):
    for words in (["--no-such"], ["DIR", "--no-such"]):
        code, said, wrong = run(command, *words)
        assert code == 2 and not said and wrong.count("\n") == 1 and wrong.startswith(("error: ", "usage: "))


@pytest.mark.parametrize("command", COMMANDS)
def test_a_python_without_the_packages_is_told_in_one_line_which_one_to_use(command, tmp_path):
    """-S leaves the folder of installed packages out."""
    done = subprocess.run([sys.executable, "-S", "-m", command, "--help"], cwd=tmp_path, capture_output=True,
                          encoding="utf-8", env={**os.environ, "PYTHONPATH": str(ROOT)})
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert done.stderr.endswith(" has no numpy, scipy, matplotlib: use /usr/bin/python3, whose packages `make setup` "
                                "installs\n")


@pytest.mark.filterwarnings("ignore:.*found in sys.modules:RuntimeWarning")
@pytest.mark.parametrize("campaign", "grains rock_laws sharp_and_worn slow steady_cut toughness_size uniaxial".split())
def test_reading_runs_of_a_folder_that_is_not_there_is_refused_in_one_line(run, campaign):
    code, said, wrong = run(f"calibration.campaigns.{campaign}", "missing", "--read")
    assert code == 2 and not said and wrong.count("\n") == 1 and wrong.startswith("error: DIR = missing must be ")

"""What a script says to lists of words, each as if it were started with them, in one process of YADE.

    yade -n -x refusals.py SCRIPT CASES.json CHECKS.json

CASES.json: [[word, ...], ...]. Writes [[exit code, what it said], ...]; code 0: it would have begun to run.
"""
import contextlib
import io
import json
import os
import runpy
import sys
from pathlib import Path
from unittest import mock

from rockwear.run import main as run


class Left(BaseException):
    """The run has ended; args[0]: exit code."""


def leave(code):
    raise Left(code)


def start(script, words):
    """-> (exit code, what it said)."""
    said = io.StringIO()
    with (mock.patch.object(sys, "argv", [script, *words]),
          contextlib.redirect_stderr(said), contextlib.redirect_stdout(said)):
        try:
            runpy.run_path(script)
        except Left as left:
            return left.args[0], said.getvalue()
    raise AssertionError(f"{script} did not end by rockwear.run.main")


run._leave = leave
run.Run.go = lambda self: 0
script, cases, checks = sys.argv[-3:]
found = [start(script, words) for words in json.loads(Path(cases).read_text(encoding="utf-8"))]
Path(checks).write_text(json.dumps(found), encoding="utf-8")
sys.stdout.flush()
os._exit(0)

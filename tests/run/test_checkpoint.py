"""Checkpoints: what goes in comes out, the last good one survives a failed write, and nothing damaged is accepted."""
import gzip
import json

import numpy as np
import pytest

from rockwear.run import checkpoint

IDENTITY = {"scene": "a", "parameters": {"kn": 1.0}}
STATE = {"stage": 2, "clock": 0.1, "engines": {"wear": {"alive": np.array([True, False]), "rows": [[1.0, 2.0]]}}}


def write_scene(directory):
    with gzip.open(directory / "scene.yade.gz", "wb") as stream:
        stream.write(b"bodies" * 1000)


def save(folder, state=STATE, scene=write_scene):
    checkpoint.save(folder, identity=IDENTITY, state=state, write_scenes=scene)


def test_what_goes_in_comes_out(tmp_path):
    save(tmp_path)
    save(tmp_path, {**STATE, "stage": 3})
    state, directory = checkpoint.load(tmp_path, IDENTITY)
    assert int(state["stage"]) == 3 and float(state["clock"]) == 0.1
    assert state["engines"]["wear"]["alive"].tolist() == [True, False]
    assert (directory / "scene.yade.gz").exists()
    assert len([p for p in tmp_path.iterdir() if p.is_dir()]) == 1


@pytest.mark.parametrize("failure", ["raises", "cut short"])
def test_a_failed_write_leaves_the_last_good_one(tmp_path, failure):
    def broken(directory):
        write_scene(directory)
        if failure == "raises":
            raise OSError("no space")
        file = directory / "scene.yade.gz"
        file.write_bytes(file.read_bytes()[:20])

    save(tmp_path)
    with pytest.raises(OSError):
        save(tmp_path, {**STATE, "stage": 9}, broken)
    assert int(checkpoint.load(tmp_path, IDENTITY)[0]["stage"]) == 2


def test_refusals_say_why(tmp_path):
    with pytest.raises(checkpoint.CheckpointError, match="there is none"):
        checkpoint.load(tmp_path, IDENTITY)
    save(tmp_path)
    with pytest.raises(checkpoint.CheckpointError, match="kn is 1.0 there and 2.0 here"):
        checkpoint.load(tmp_path, {"scene": "a", "parameters": {"kn": 2.0}})
    with pytest.raises(checkpoint.CheckpointError, match="same scene: a there, b here"):
        checkpoint.load(tmp_path, {"scene": "b"})
    file = next(tmp_path.glob("*/state.npz"))
    file.write_bytes(file.read_bytes()[:-1])
    with pytest.raises(checkpoint.CheckpointError, match="state.npz is missing or damaged"):
        checkpoint.load(tmp_path, IDENTITY)
    whole = json.loads((tmp_path / "current.json").read_text(encoding="utf-8"))
    for name in ("identity", "files", "set"):
        rest = {key: value for key, value in whole.items() if key != name}
        (tmp_path / "current.json").write_text(json.dumps(rest), encoding="utf-8")
        with pytest.raises(checkpoint.CheckpointError, match="lacks some of identity, files and set"):
            checkpoint.load(tmp_path, IDENTITY)
    (tmp_path / "current.json").write_text(json.dumps({"format": "another"}), encoding="utf-8")
    with pytest.raises(checkpoint.CheckpointError, match="of the format"):
        checkpoint.load(tmp_path, IDENTITY)

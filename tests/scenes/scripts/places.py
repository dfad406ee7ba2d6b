"""Whether contacts that engines keep by their places in memory are among YADE's in every step of a cut, and those said
to touch are those that do; writes {"steps", "searches", "lost", "asked late", "wrong", "moved", "cracks", "worn":
numbers} to FILE.

    yade -n -x places.py FILE --out DIR
"""
import json
import os
import sys

import numpy as np
from yade import FrictPhys, O

from rockwear.engines import base
from rockwear.engines.memory import WORDS, list_of_contacts, pointed
from rockwear.run import parameters, servers
from rockwear.run.main import COMMON
from rockwear.scenes import steady_cut

CUT = dict(discs_per_depth=4, depth_of_cut=2e-3, tip_radius=2e-4, velocity=40.0, cut_length=0.01, heat=True,
           wear_acceleration=2000.0, rock_sampling_period=100)
ASKED = 20
"""Steps between looks at the pairs that touch."""


def all_contacts():
    """(k,) indices in memory of all contacts of the scene, also those that the collider holds possible only."""
    begin, end = WORDS[list_of_contacts():][:2].tolist()
    return pointed(WORDS[pointed(begin):pointed(end):2])


class Probe(base.Engine):
    """Compares places in each step in which nobody has to search anew, and pairs now and then in any."""

    name, phase = "probe", base.FORCES

    def __init__(self, scene):
        super().__init__()
        self.scene, self.steps, self.searches, self.lost, self.late, self.wrong = scene, 0, set(), 0, 0, 0

    def act(self):
        friction, contact = self.scene.rock_friction, self.scene.tool.contact
        if friction.collider.numAction == friction.seen:
            kept = np.concatenate([friction.places[:, 0], contact.places])
            self.lost += int(np.count_nonzero(~np.isin(kept, all_contacts())))
            self.steps += 1
            self.searches.add(friction.seen)
        if O.iter % ASKED == 0:
            self.late += friction.collider.numAction != friction.seen
            count = friction.particles
            there = {tuple(sorted((i.id1, i.id2))) for i in O.interactions
                     if max(i.id1, i.id2) < count and type(i.phys) is FrictPhys}
            self.wrong += len(there ^ set(map(tuple, np.sort(friction.touching_pairs(), axis=1).tolist())))


def main():
    """Cut, and write."""
    file, words = sys.argv[1], sys.argv[2:]
    servers.close()
    scene = steady_cut.make(parameters.read([*steady_cut.groups(**CUT), COMMON], words))
    probe = Probe(scene)
    register = scene._register
    scene._register = lambda *engines: register(*engines, probe)
    scene.build()
    before = scene.programme.window.rock.places.copy()
    while scene.programme.distance < CUT["cut_length"] - 1e-3:
        scene.run_chunk()
    moved = int(np.any(scene.programme.window.rock.places != before, axis=1).sum())
    with open(file, "w", encoding="utf-8") as out:
        json.dump({"steps": probe.steps, "searches": len(probe.searches), "lost": probe.lost, "asked late": probe.late,
                   "wrong": probe.wrong, "moved": moved, "cracks": len(scene.bonds.cracks),
                   "worn": scene.tool.volume_balance()["archard"]}, out)
    os._exit(0)


if __name__ == "__main__":
    main()

"""Bonds as the cut makes them: free of stress, with no burst when all of them break, and plain contacts afterwards."""
import json
import os
import sys

from yade import FrictPhys, JCFpmPhys, O, utils

from rockwear.run import parameters
from rockwear.run.main import COMMON
from rockwear.scenes import cutting

found = {}
scene = cutting.make(parameters.read([*cutting.GROUPS, COMMON], sys.argv[1:]))
scene.build()
scene.tool.bodies.erase(list(scene.tool.bodies.body_of))
rock = scene.rock


def largest_force():
    return max(i.phys.normalForce.norm() + i.phys.shearForce.norm() for i in O.interactions)


bonds = [i for i in O.interactions if isinstance(i.phys, JCFpmPhys)]
found["bonds"], found["pairs"] = len(bonds), len(rock.pairs)
found["others"] = sum(1 for i in O.interactions) - len(bonds)
found["overlapping"] = sum(i.geom.penetrationDepth > 1e-6 for i in bonds)
O.run(100, True)
found["force_at_rest"] = largest_force()

for i in bonds:
    i.phys.isCohesive, i.phys.FnMax, i.phys.FsMax = False, 0.0, 0.0
O.run(2000, True)
found["kinetic_after_all_broke"], found["force_after_all_broke"] = utils.kineticEnergy(), largest_force()

# Two particles far from each other, thrown together: a contact that never was a bond.
first, second = O.bodies[0], O.bodies[1]
for i in list(O.interactions.withBody(0)) + list(O.interactions.withBody(1)):
    O.interactions.erase(i.id1, i.id2)
reach = first.shape.radius + second.shape.radius
first.state.blockedDOFs = second.state.blockedDOFs = "xyzXYZ"
first.state.pos, second.state.pos = (1.0, 0, 0), (1.0 + reach - 1e-6, 0, 0)
second.state.vel = (0, 0.1, 0)
O.run(50, True)
contact = O.interactions[0, 1]
overlap = reach - (second.state.pos - first.state.pos).norm()
found["new_contact"] = {"is_plain": isinstance(contact.phys, FrictPhys), "kn": contact.phys.kn, "ks": contact.phys.ks,
                        "friction": contact.phys.tangensOfFrictionAngle, "force": contact.phys.normalForce.norm(),
                        "expected_force": scene.bond_law.kn * contact.geom.penetrationDepth, "overlap": overlap,
                        "friction_ratio": contact.phys.shearForce.norm() / contact.phys.normalForce.norm()}

print("RESULT " + json.dumps(found))
sys.stdout.flush()
os._exit(0)

"""The heat engine over thermal bodies, its contacts and rock given by hand; writes {check: {name: value}} as JSON.

    yade -n -x heat.py FILE
"""
import json
import os
import sys
from types import SimpleNamespace

import numpy as np
from yade import O, utils

from rockwear.engines.facet_contact import SLIP
from rockwear.engines.facet_wear import FacetWear
from rockwear.engines.heat import Heat
from rockwear.kernels.archard import Hardness
from rockwear.kernels.boundary import area_vectors, prism
from rockwear.kernels.conduction import STEFAN_BOLTZMANN, HeatNetwork
from rockwear.kernels.polygon import tooth
from rockwear.kernels.voronoi import cells
from rockwear.kernels.wear_laws import WORK
from rockwear.model.facet_tool import FacetTool
from rockwear.model.materials import STEEL
from rockwear.model.particle_tool import LayeredTool
from rockwear.model.thermal_body import FacetBody, ParticleBody

LENGTH, HEIGHT, BREADTH = 0.016, 0.008, 0.006
BLOCK = np.array([[0, 0], [LENGTH, 0], [LENGTH, HEIGHT], [0, HEIGHT]])
FIRST = 300.0
STEP = 1e-3
C_ROCK = 5.0
ROCK = np.array([[1.0, 1.0, 0.0], [2.0, 1.0, 0.0]])
O.bodies.append([utils.sphere(place, 2e-3) for place in ROCK.tolist()])


def fill():
    """Squares of 1 mm that fill BLOCK."""
    x, y = np.meshgrid(np.arange(16) + 0.5, np.arange(8) + 0.5)
    places = 1e-3 * np.column_stack([x.ravel(), y.ravel()])
    return SimpleNamespace(positions=places, radii=np.full(128, 0.5e-3), volumes=np.full(128, 1e-6),
                           fixed=places[:, 1] > HEIGHT - 1e-3, cells=cells(places, polygon=BLOCK))


def in_plane():
    """(tool, body) of facets in the plane, and in space."""
    tool = FacetTool.of_outline(BLOCK, segment=0.5e-3, density=STEEL.density)
    return tool, FlatBody(tool, fill=fill())


def in_space():
    vertices, facets = prism(BLOCK, BREADTH, 3e-3)
    tool = FacetTool(vertices=vertices, facets=facets, density=STEEL.density)
    return tool, FacetBody(tool, fill=fill(), breadth=BREADTH)


class FlatBody(FacetBody):
    """Its fill is no Tool: it conducts through its cells."""

    def paths(self, model, conductivity):
        return self.cells.edges, self.cells.conductance(conductivity)


class Engines:
    """What the heat engine asks of contacts and rock; `put` sets the next visit's friction and contacts."""

    def __init__(self, pieces, dimension):
        self.pieces = pieces
        self.pairs = np.empty((0, 2), int)
        self.count, self.radii = 2, np.full(2, 2e-3)
        self.fixed, self.absent = np.zeros((2, 2), bool)
        self.positions = ROCK[:, :dimension]
        self.put({}, {})

    def goes_on(self):
        return self.fixed

    def put(self, work, touching):
        self.work, self.touching = work, touching

    def take_heating(self):
        work = np.zeros(self.pieces)
        for piece, joules in self.work.items():
            work[piece] = joules
        taken = work, np.array([work.sum(), 0.0]), dict(self.touching)
        self.put({}, {})
        return taken

    def take_work(self):
        return np.zeros(2)

    def take_slip_work(self, particles):
        return np.zeros(particles)

    def find_contacts(self):
        pass

    def touching_pairs(self):
        return np.empty((0, 2), int)

    def in_contact(self):
        return np.zeros(0, bool)


def engine(body, engines, **changes):
    capacity = np.concatenate([np.full(2, C_ROCK), body.capacities(STEEL, "voronoi")])
    network = HeatNetwork(capacity=capacity, temperature=FIRST, edges=np.empty((0, 2), int), conductance=0.0)
    values = dict(heat_fraction=0.85, tool_share=0.75, contact_conductance=0.0, convection=0.0, ambient=280.0,
                  surface_period=2 * STEP, rock_paths=(np.empty((0, 2), int), np.empty(0)),
                  tool_paths=body.paths("voronoi", STEEL.conductivity))
    made = Heat(network=network, bonds=engines, rock_friction=engines, tool_contact=engines, rock=engines, body=body,
                **{**values, **changes})
    made.begin()
    return made


def visit(heat, work=(), touching=()):
    """One visit after STEP seconds."""
    heat.tool_contact.put(dict(work), dict(touching))
    O.dt, heat.last_iteration = STEP, O.iter - 1
    heat.act()


def lowest(tool):
    """Facets at the bottom of the block."""
    areas = area_vectors(tool.boundary.vertices, tool.boundary.facets)
    return areas[:, 1] < -0.9 * np.linalg.norm(areas, axis=1)


def recede(tool, depth):
    areas = np.linalg.norm(area_vectors(tool.boundary.vertices, tool.boundary.facets), axis=1)
    tool.boundary.wear(np.where(lowest(tool), areas * depth, 0.0))


def missing(heat):
    """What the balance misses over the heat that there was at first."""
    return abs(heat.balance()["residual"]) / heat.initial_content


def friction(make):
    """All friction heat arrives: at first in the nodes of the rubbed facets, later in all of the body."""
    tool, body = make()
    heat = engine(body, Engines(tool.count, body.positions.shape[1]))
    rubbed = np.flatnonzero(lowest(tool))[:2].tolist()
    O.dt, heat.last_iteration = STEP, O.iter
    heat.tool_contact.put({facet: 4.0 for facet in rubbed}, {})
    heat.act()
    rise = heat.tool_temperature() - FIRST
    warm = np.flatnonzero(rise).tolist()
    for _ in range(20):
        visit(heat, {facet: 1.0 for facet in rubbed})
    later = heat.tool_temperature() - FIRST
    capacity = heat.network.capacity
    return {"warm": warm, "nodes": sorted(set(body.node_of[rubbed].tolist())), "spread": int((later > 0).sum()),
            "count": body.count, "tool": float(capacity[2:] @ later), "tool_exact": 0.85 * 0.75 * (8 + 40),
            "rock": float(capacity[:2] @ (heat.network.temperature[:2] - FIRST)), "rock_exact": 0.85 * 0.25 * (8 + 40),
            "hottest": float(heat.temperature_of_pieces()[rubbed].max() - later.max()), "missing": missing(heat)}


def exchange(make):
    """Facets of one node and a rock particle in perfect contact reach one temperature; moderate contact is exact."""
    tool, body = make()
    found = {}
    node = int(body.node_of[np.flatnonzero(lowest(tool))[3]])
    facets = np.flatnonzero(body.node_of == node).tolist()
    for name, conductance in (("perfect", 1e12), ("moderate", 2e5)):
        heat = engine(body, Engines(tool.count, body.positions.shape[1]), contact_conductance=conductance,
                      tool_paths=(np.empty((0, 2), int), np.empty(0)))
        state = heat.network.state()
        state["temperature"][2 + node] = 700.0
        heat.network.restore(state)
        heat.initial_content = heat.network.heat_content
        visit(heat, touching={(facet, 1): STEP for facet in facets})
        rock, steel = heat.network.temperature[[1, 2 + node]]
        capacity = heat.network.capacity[2 + node]
        width = np.minimum(body.contact_areas[facets], (2 * 2e-3)**(body.positions.shape[1] - 1)).sum()
        decay = np.exp(-conductance * width * STEP * (1 / C_ROCK + 1 / capacity))
        found[name] = {"gap": float(steel - rock), "exact": float(400.0 * decay),
                       "mixture": float(C_ROCK * rock + capacity * steel),
                       "whole": float(C_ROCK * 300.0 + capacity * 700.0)}
        power, touch, warmth = heat.averages()
        found[name].update(touch=float(touch.sum()), touch_exact=float(conductance * width),
                           rock_mean=float(warmth[node]))
    return found


def shared(make):
    """One node on both rock particles, in perfect contact at once: all three reach one temperature, and stay there."""
    tool, body = make()
    facet = int(np.flatnonzero(lowest(tool))[3])
    node = int(body.node_of[facet])
    heat = engine(body, Engines(tool.count, body.positions.shape[1]), contact_conductance=1e12,
                  tool_paths=(np.empty((0, 2), int), np.empty(0)))
    state = heat.network.state()
    state["temperature"][2 + node] = 700.0
    heat.network.restore(state)
    rows = []
    for _ in range(3):
        visit(heat, touching={(facet, 0): STEP, (facet, 1): STEP})
        rows.append(heat.network.temperature[[0, 1, 2 + node]].tolist())
    capacity = heat.network.capacity[2 + node]
    return {"rows": rows, "mixed": float((2 * C_ROCK * FIRST + capacity * 700.0) / (2 * C_ROCK + capacity))}


def worn(make, acceleration):
    """A hot bottom recedes by two rows of nodes: what leaves, what stays, and that the balance closes."""
    tool, body = make()
    heat = engine(body, Engines(tool.count, body.positions.shape[1]), contact_conductance=3e4, convection=50.0,
                  wear_acceleration=acceleration, shank_temperature=FIRST)
    rubbed = np.flatnonzero(lowest(tool)).tolist()
    removed_capacity = 0.0
    for n in range(24):
        if n % 4 == 3:
            before = heat.network.capacity.sum()
            recede(tool, 0.35e-3)
        visit(heat, {facet: 0.3 for facet in rubbed}, {(facet, n % 2): STEP for facet in rubbed[:4]})
        if n % 4 == 3:
            removed_capacity += float(before - heat.network.capacity.sum())
    alive = body.alive
    return {"dead": int((~alive).sum()), "gone": bool(np.array_equal(heat.network.capacity[2:] > 0, alive)),
            "missing": missing(heat), "hottest": float(heat.tool_temperature()[alive].max()),
            "shank": np.ptp(heat.tool_temperature()[body.fixed & alive]).item(),
            "taken": -heat.balance()["removed"] - FIRST * removed_capacity,
            "made": heat.balance()["generated"], "to_air": -heat.balance()["convected"],
            "facets_alive": bool(alive[body.node_of].all())}


def restart(make):
    """A body restored in mid-recession goes on as the one that was never stopped."""
    def loads(n, tool):
        rubbed = np.flatnonzero(lowest(tool)).tolist()
        return {facet: 0.3 for facet in rubbed}, {(facet, n % 2): STEP for facet in rubbed[:4]}

    settings = dict(contact_conductance=3e4, convection=50.0, wear_acceleration=100.0, shank_temperature=290.0)
    tool, body = make()
    heat = engine(body, Engines(tool.count, body.positions.shape[1]), **settings)
    for n in range(8):
        visit(heat, *loads(n, tool))
        recede(tool, 0.2e-3)  # after the visit: the state is saved with the shape not followed yet
    saved = heat.state(), tool.boundary.state()
    other, other_body = make()
    again = engine(other_body, Engines(other.count, body.positions.shape[1]), **settings)
    other.boundary.restore(saved[1])
    again.restore(saved[0])
    same = np.array_equal(heat.temperature_of_pieces(), again.temperature_of_pieces())
    for n in range(8, 16):
        for one, shape in ((heat, tool), (again, other)):
            visit(one, *loads(n, shape))
            recede(shape, 0.1e-3)
    return {"same_at_once": bool(same), "dead": int((~body.alive).sum()),
            "same": bool(np.array_equal(heat.network.temperature, again.network.temperature)
                         and heat.balance() == again.balance() and np.array_equal(body.alive, other_body.alive))}


def radiating(make):
    """Nodes that conduct no heat and rock particles far from each other radiate for themselves into the cold: in time
    t each comes to T (1 + 3 sigma eA T^3 t / C)^(-1/3), in many short visits."""
    tool, body = make()
    empty = np.empty((0, 2), int), np.empty(0)
    heat = engine(body, Engines(tool.count, body.positions.shape[1]), emissivity=0.7, ambient=0.0, tool_paths=empty)
    state = heat.network.state()
    state["temperature"][:] = 1400.0
    heat.network.restore(state)
    heat.initial_content = heat.network.heat_content
    sizes = 2 * np.pi * 2e-3 if make is in_plane else 4 * np.pi * 2e-3**2
    free = np.concatenate([np.full(2, sizes), body.exposed(np.zeros(tool.count, bool))])
    rate = 3 * STEFAN_BOLTZMANN * 0.7 * free * 1400.0**3 / heat.network.capacity
    seconds = 4.0 / rate.max()
    for _ in range(2000):
        heat.cool(seconds / 2000)
    exact = 1400.0 * (1 + rate * seconds)**(-1 / 3)
    return {"coldest": float(exact.min()), "dark": int((free == 0).sum()), "missing": missing(heat),
            "error": float(abs(heat.network.temperature - exact).max()), "radiated": heat.balance()["radiated"],
            "rock": float(abs(heat.network.temperature[:2] - exact[:2]).max()), "rock_cooled": 1400.0 - float(exact[0])}


def renewed():
    """A whole tool in place of a worn one."""
    tool, body = in_plane()
    new = tool.boundary.state()
    heat = engine(body, Engines(tool.count, 2), wear_acceleration=10.0)
    for _ in range(3):
        recede(tool, 0.7e-3)
        visit(heat, {int(np.flatnonzero(lowest(tool))[0]): 3.0})
    dead = int((~body.alive).sum())
    tool.boundary.restore(new)
    heat.renew_tool(np.full(body.count, 320.0))
    visit(heat, {int(np.flatnonzero(lowest(tool))[0]): 3.0})
    return {"dead": dead, "alive": int(body.alive.sum()), "count": body.count, "missing": missing(heat)}


def rock_renewed():
    """Other rock in place of the first of two particles, which stand in the wind: their temperatures at once, and after
    each of three visits, before whose second the next search for surfaces is not due."""
    tool, body = in_plane()
    heat = engine(body, Engines(tool.count, 2), convection=1e4, emissivity=0.9)
    heat.renew_rock(np.array([0]), 350.0)
    rows = [heat.network.temperature[:2].tolist()]
    for _ in range(3):
        visit(heat)
        rows.append(heat.network.temperature[:2].tolist())
    return {"rows": rows, "replaced": heat.balance()["rock_replaced"], "exact": C_ROCK * (350.0 - FIRST),
            "missing": missing(heat)}


def absent():
    """Temperatures in the wind of a particle that is not there and one that is."""
    tool, body = in_plane()
    engines = Engines(tool.count, 2)
    engines.absent[0] = True
    heat = engine(body, engines, convection=1e4, emissivity=0.9)
    visit(heat)
    return heat.network.temperature[:2].tolist()


def particles():
    """A tool of spheres: friction, exchange, convection, wear, loose pieces and a fixed shank in one balance."""
    outline = tooth(height=0.02, width=0.012, rake=0.2, clearance=0.1, tip_radius=2e-3)
    tool = LayeredTool(vertices=outline, radius=0.7e-3, breadth=0.006, seed=1, removal="volume", density=STEEL.density)
    body = ParticleBody(tool)
    heat = engine(body, Engines(tool.count, 3), contact_conductance=2e4, convection=100.0, wear_acceleration=1000.0,
                  shank_temperature=310.0)
    tip = np.argsort(tool.positions[:, 1])[:12].tolist()
    for n in range(30):
        alive = [i for i in tip if tool.erosion.alive[i]]
        if n % 6 == 5:
            tool.erosion.alive[alive[:2]] = False
            heat.tool_contact.put({alive[0]: 0.1}, {(alive[0], 0): STEP})
            heat.remove(alive[:1], alive[1:2])
        else:
            visit(heat, {i: 0.2 for i in alive}, {(i, n % 2): STEP for i in alive[:5]})
    balance, temperature = heat.balance(), heat.temperature_of_pieces()
    return {"missing": missing(heat), "hottest": int(np.argmax(temperature)) in tip, "entries": balance,
            "shank": float(np.ptp(temperature[tool.fixed])), "count": tool.count,
            "gone": int((~tool.erosion.alive).sum())}


def fallen():
    """The heat of a hot particle that accelerated wear takes away stays in the tool, whatever falls off with it.
    -> J that the tool is to keep, and J that left above those of the first temperature."""
    outline = tooth(height=0.02, width=0.012, rake=0.2, clearance=0.1, tip_radius=2e-3)
    tool = LayeredTool(vertices=outline, radius=0.7e-3, breadth=0.006, seed=1, removal="volume", density=STEEL.density)
    heat = engine(ParticleBody(tool), Engines(tool.count, 3), wear_acceleration=1e12)
    tip = int(np.argmin(tool.positions[:, 1]))
    beside = heat.below[[tip]].indices
    capacity, joules = heat.network.capacity[2:].copy(), np.zeros(2 + tool.count)
    joules[2 + tip] = 600.0 * capacity[tip]
    heat.network.add_heat(joules)
    loose = beside[:len(beside) // 2].tolist()
    heat.remove([tip], loose)
    cold = FIRST * capacity[[tip, *loose]].sum()
    return [float(joules.sum()), float(-heat.balance()["removed"] - cold)]


class Rubbed(Engines):
    """Contacts that rub the bottom of the tool, `depth` (m) of which the wear takes at each visit."""

    def __init__(self, tool, depth):
        super().__init__(tool.count, 2)
        self.tool, self.depth = tool, depth

    def areas(self):
        boundary = self.tool.boundary
        return np.linalg.norm(area_vectors(boundary.vertices, boundary.facets), axis=1)

    def take_slid(self):
        where = np.where(lowest(self.tool), self.areas(), 0.0)
        return {WORK: where, SLIP: where}

    def volume(self, slid, hardness, areas):
        """As a wear law."""
        return self.depth * slid[WORK]

    def elastic_energy(self):
        return 0.0

    def nothing(self, *_):
        return None

    reshape = shape_has_changed = contact_inside_tool = nothing


def remeshed():
    """Friction before facets change places, by the places where it arose: at each node, beside what it should be."""
    tool, body = in_plane()
    contact = Rubbed(tool, 0.1e-3)
    heat = engine(body, contact, tool_paths=(np.empty((0, 2), int), np.empty(0)))
    wear = FacetWear(contact=contact, boundary=tool.boundary, tool=contact, law=contact,
                     hardness=Hardness.constant(1e9), temperature=lambda: np.full(tool.count, FIRST),
                     on_remeshing=heat.remove)
    for _ in range(60):
        visit(heat)
        pending, before = dict(enumerate((1.0 + np.arange(tool.count)).tolist())), tool.boundary.remeshed
        places, first = body.node_of.copy(), heat.network.temperature[2:].copy()
        heat.tool_contact.put(pending, {})
        wear.act()
        if tool.boundary.remeshed > before:
            body.follow()
            if (moved := int((body.node_of != places).sum())) > 5:
                break
        heat.tool_contact.put({}, {})
    O.dt, heat.last_iteration = STEP, O.iter - 1
    heat.act()
    rise = (heat.network.temperature[2:] - first) * heat.network.capacity[2:]
    should = 0.85 * 0.75 * np.bincount(places, list(pending.values()), body.count)
    return {"moved": moved, "rise": rise.tolist(), "should": should.tolist()}


MAKERS = {"plane": in_plane, "space": in_space}
found = {"renewed": renewed(), "remeshed": remeshed(), "rock renewed": rock_renewed(), "absent": absent(),
         "particles": particles(), "fallen": fallen()}
for name, maker in MAKERS.items():
    found[name] = {"radiating": radiating(maker), "friction": friction(maker), "exchange": exchange(maker),
                   "shared": shared(maker),
                   "restart": restart(maker), "worn": {str(a): worn(maker, a) for a in (1.0, 1e4)}}
with open(sys.argv[-1], "w", encoding="utf-8") as file:
    json.dump(found, file)
os._exit(0)

"""Heat in rock and tool: friction, conduction, exchange across contacts, convection and radiation from free surfaces.
"""
import math

import numpy as np

from rockwear.engines import access
from rockwear.engines.base import Engine
from rockwear.kernels.free_surface import free_surface
from rockwear.kernels.surface_recession import neighbours, receded
from rockwear.kernels.tool_load import MeanLoad
from rockwear.kernels.voronoi import among, conducting


class Heat(Engine):
    """One HeatNetwork over rock particles (nodes 0..n-1) and the tool (n..n+m-1), staggered with the mechanics.

    Friction heat chi W, with the work W of irreversible slip, is shared between tool and rock [Rojek 2014, eqs. 36-41],
    and in halves between rock particles, which slip in loose contacts or within their bonds. A piece of the tool
    (particle or facet) and a rock particle in contact exchange h A (T_tool - T_rock) [Rojek 2014, eq. 66] during their
    contact time; A is the piece's contact area, but no more than the rock particle is wide. It is the exact exchange of
    two lumps; what touches several gives each a part of its heat, so that none overshoots. Convection acts on the free
    surface [Rojek 2014, eq. 42], which is found anew every surface_period, and so does radiation, e sigma A (T^4 -
    T_ambient^4) [Rojek 2003, 7.2]. Of surfaces that face each other, in a crack say, each radiates to the surroundings.

    network: kernels.conduction.HeatNetwork; bonds, rock_friction, tool_contact: engines; rock: the specimen; body:
    model.thermal_body.ThermalBody of the tool;
    heat_fraction: chi; tool_share: part of the heat of tool-rock friction that the tool takes;
    contact_conductance, convection: W/m2K; emissivity: e, 0 for no radiation; ambient: K; surface_period: s;
    rock_paths, tool_paths: pairs (k, 2) of particles or nodes that exchange heat, and their conductances (k,) W/K;
    conduction: False leaves all heat where it arises;
    wear_acceleration: A; a particle or node that accelerated wear removes takes 1 / A of its heat along, the rest goes
    to those below it (kernels.surface_recession);
    shank_temperature: K at which the shank holds the tool's fixed nodes, None where they are insulated;
    time_scale: a function that gives the seconds of the process, in which heat flows, in a second of the mechanics
    [Rojek 2003, 12.1].
    """

    name = "heat"

    def __init__(self, *, network, bonds, rock_friction, tool_contact, rock, body, heat_fraction, tool_share,
                 contact_conductance, convection, ambient, rock_paths, tool_paths, surface_period, emissivity=0.0,
                 wear_acceleration=1.0, conduction=True, shank_temperature=None, time_scale=lambda: 1.0, period=1):
        super().__init__(period=period)
        self.network, self.bonds, self.rock_friction, self.tool_contact = network, bonds, rock_friction, tool_contact
        self.rock, self.body, self.n = rock, body, rock.count
        self.heat_fraction, self.tool_share, self.conduction = heat_fraction, tool_share, conduction
        self.contact_conductance, self.ambient = contact_conductance, ambient
        self.convection, self.emissivity = convection, emissivity
        self.rock_paths, self.tool_paths = rock_paths, tool_paths
        self.below, self.kept_share = neighbours(tool_paths[0], body.count), 1 - 1 / max(wear_acceleration, 1.0)
        self.facing = ~among(rock_paths[0], bonds.pairs, self.n)
        self.surface_period, self.shank_temperature, self.time_scale = surface_period, shank_temperature, time_scale
        self.replaced = self.renewed = 0.0
        self.surface_time = -math.inf
        self.clock = 0.0
        self.touched = np.empty((0, 2), int)
        self.tool_capacity = network.capacity[self.n:]
        self.start_average()

    def begin(self):
        """Start the balance, before the first step."""
        self._hold_shank()
        self.initial_content = self.network.heat_content - self.network.balance["into_fixed"]
        if self.conduction:
            self.find_surfaces()

    def act(self):
        elapsed = self.elapsed() * self.time_scale()
        self.clock += elapsed
        self.load.seconds += elapsed
        passed = self.body.follow()
        self.network.add_heat(self._sources())
        if passed:
            self._take_out(passed)
        if self.conduction:
            self.network.advance(elapsed)
            if self.clock - self.surface_time >= self.surface_period:
                self.find_surfaces()

    def cool(self, seconds):
        """Let heat flow for so many seconds of the process while the mechanics stand still."""
        self.clock += seconds
        if self.conduction:
            self.network.advance(seconds)

    # ---- friction, and exchange between tool and rock

    def _sources(self):
        """(n + m,) J that friction and the exchange between tool and rock bring since the last call."""
        tool_work, rock_work, touching = self.tool_contact.take_heating()
        rock = (1 - self.tool_share) * rock_work + self.rock_friction.take_work() + self.bonds.take_slip_work(self.n)
        tool_work = np.bincount(self.body.node_of, tool_work, self.body.count)
        heat = self.heat_fraction * np.concatenate([rock, self.tool_share * tool_work])
        self.load.friction_heat += heat[self.n:]
        self.touched = np.array(sorted(touching), int).reshape(-1, 2)
        if touching and self.conduction:
            seconds = np.array([touching[i, j] for i, j in self.touched.tolist()])
            self._exchange(heat, self.time_scale() * seconds)
        return heat

    def _exchange(self, heat, seconds):
        """Add to `heat` (n + m,) J what the touched pairs exchange in their contact times (s)."""
        piece, rock = self.touched.T
        width = (2 * self.rock.radii[rock])**(self.body.positions.shape[1] - 1)
        areas = np.minimum(self.body.contact_areas[piece], width)
        # Facets of one node on one particle act as one contact.
        pairs, which = np.unique(np.column_stack([self.body.node_of[piece], rock]), axis=0, return_inverse=True)
        passed = np.bincount(which.ravel(), self.contact_conductance * areas * seconds, len(pairs))
        capacity, temperature = self.network.capacity, self.network.temperature
        there = (capacity[self.n + pairs[:, 0]] > 0) & (passed > 0)
        node, rock, passed = pairs[there, 0], pairs[there, 1], passed[there]
        tool = self.n + node
        # Each contact of a node has the part of its capacity that it has of what passes there.
        own, other = (capacity[one] * _share(passed, one) for one in (tool, rock))
        lumped = own * other / (own + other)
        self.load.contact += np.bincount(node, passed, self.body.count)
        self.load.contact_kelvin += np.bincount(node, passed * temperature[rock], self.body.count)
        moved = (temperature[tool] - temperature[rock]) * lumped * -np.expm1(-passed / lumped)
        heat += np.bincount(rock, moved, heat.size) - np.bincount(tool, moved, heat.size)

    # ---- contacts that conduct, surfaces that convect and radiate

    def find_surfaces(self):
        """Find which contacts conduct and which surfaces convect and radiate now."""
        self.surface_time = self.clock
        self._find_paths()
        rock = free_surface(positions=access.rock_positions(self.rock), radii=self.rock.radii)
        rock[self.rock.goes_on() | self.rock.absent] = rock[self.touched[:, 1]] = 0.0
        touched = np.zeros(len(self.body.node_of), bool)
        touched[self.touched[:, 0]] = True
        exposed = np.concatenate([rock, self.body.exposed(touched)])
        present = np.flatnonzero(np.concatenate([np.ones(self.n, bool), self.body.alive]))
        self._expose(present, exposed[present])

    def _expose(self, nodes, areas):
        self.network.convect(nodes, self.convection * areas, self.ambient)
        if self.emissivity:
            self.network.radiate(nodes, self.emissivity * areas, self.ambient)

    def _find_paths(self):
        """Find which contacts conduct now."""
        self.rock_friction.find_contacts()
        pairs, conductance = self._rock_now()
        tool, of_tool = self.tool_paths
        alive = self.body.alive[tool].all(axis=1)
        self.network.rewire(edges=np.concatenate([pairs, tool[alive] + self.n]),
                            conductance=np.concatenate([conductance, of_tool[alive]]))

    def leave_rock(self):
        """Nothing touches the tool any more: all of its surface is free."""
        self.touched = np.empty((0, 2), int)
        if self.conduction:
            self.find_surfaces()

    def _rock_now(self):
        """Rock particles in contact conduct, and those across closed pores; new contacts with the mean conductance."""
        pairs, conductance = self.rock_paths
        loose = np.sort(self.rock_friction.touching_pairs(), axis=1)
        touching = np.concatenate([self.bonds.pairs[self.bonds.in_contact()], loose])
        conducts = conducting(pairs, among(pairs, touching, self.n), self.facing, self.n)
        met = loose[~among(loose, pairs, self.n)]
        mean = conductance.mean() if len(conductance) else 0.0
        return np.concatenate([pairs[conducts], met]), np.concatenate([conductance[conducts], np.full(len(met), mean)])

    # ---- changes of tool and rock

    def remove(self, worn=(), loose=()):
        """Tool particles are gone: `worn` ones leave the heat of accelerated wear behind, `loose` ones take theirs.
        Without any: the friction so far goes to where it arose, before facets change places."""
        # The heat of their last friction comes first.
        self.network.add_heat(self._sources())
        if worn or loose:
            self._take_out(worn, loose)

    def _take_out(self, worn, loose=()):
        network, temperature = self.network, self.network.temperature[self.n:]
        capacity = network.capacity[self.n:].copy()
        # What falls off takes no heat of what is worn.
        capacity[list(loose)] = 0.0
        after = receded(temperature=temperature, capacity=capacity, adjacent=self.below, leaving=worn,
                        share=self.kept_share)
        network.add_heat(network.capacity * np.concatenate([np.zeros(self.n), after - temperature]))
        network.remove(self.n + np.array([*worn, *loose], int))

    def replace_rock(self, temperature):
        """New rock at the start of a cycle: its particles take these (n,) K, `rock_replaced` in the balance."""
        change = np.zeros(self.network.temperature.size)
        change[:self.n] = (temperature - self.network.temperature[:self.n]) * self.network.capacity[:self.n]
        self.replaced += float(change.sum())
        self.network.add_heat(change)

    def renew_rock(self, numbers, temperature):
        """The particles `numbers` (k,) are other rock now, of this temperature (K). Until the next search for surfaces
        it counts as not exposed."""
        kelvin = self.network.temperature[:self.n].copy()
        kelvin[numbers] = temperature
        self.replace_rock(kelvin)
        if self.conduction:
            self._find_paths()
            self._expose(numbers, np.zeros(len(numbers)))

    def renew_tool(self, temperature):
        """A whole tool of (m,) K in place of the present one, `tool_renewed` in the balance."""
        self.body.renew()
        before, state = self.network.heat_content, self.network.state()
        state["capacity"][self.n:], state["temperature"][self.n:] = self.tool_capacity, temperature
        state["fixed"][self.n:] = False
        self.network.restore(state)
        self.renewed += self.network.heat_content - before
        self._hold_shank()

    def _hold_shank(self):
        if self.shank_temperature is not None:
            self.network.fix(self.n + np.flatnonzero(self.body.fixed), self.shank_temperature)

    # ---- means over a time

    def start_average(self):
        """Start the means of the tool's load anew."""
        self.load = MeanLoad(self.body.count)

    def averages(self):
        """Means since `start_average` by node: friction heat, W; conductance to the rock, W/K; temperature of the rock
        there, K; three arrays (m,)."""
        return self.load.means(self.ambient)

    # ---- results

    def tool_temperature(self):
        """(m,) K of the tool's nodes."""
        return self.network.temperature[self.n:]

    def temperature_of_pieces(self):
        """(pieces,) K of the tool's particles or facets: that of their nodes."""
        return self.tool_temperature()[self.body.node_of]

    def balance(self):
        """Heat balance in J, signed as it changes the heat of rock and tool; residual is what it does not explain."""
        balance = self.network.balance
        balance["generated"] -= self.replaced
        balance["rock_replaced"] = self.replaced
        balance["tool_renewed"] = self.renewed
        balance["stored"] = self.network.heat_content - self.initial_content
        balance["residual"] = balance["stored"] - math.fsum(v for k, v in balance.items() if k != "stored")
        return balance

    def log(self):
        tool = self.tool_temperature()[self.body.alive]
        return {"tool_temperature_max": (float(tool.max()) if len(tool) else math.nan, "K"),
                "rock_temperature_max": (float(self.network.temperature[:self.n].max()), "K")}

    def state(self):
        return {"network": self.network.state(), "body": self.body.state(), "load": self.load.state(),
                "replaced": self.replaced, "renewed": self.renewed, "clock": self.clock, "touched": self.touched.copy(),
                "surface_time": self.surface_time, "initial_content": self.initial_content}

    def restore(self, state):
        self.network.restore(state["network"])
        self.body.restore(state.get("body", {}))
        self.load.restore(state["load"])
        for name in ("replaced", "renewed", "clock", "surface_time", "initial_content"):
            setattr(self, name, float(state[name]))
        self.touched = state["touched"].astype(int).reshape(-1, 2)


def _share(values, group):
    """(k,) each of `values` (k,) > 0 over the sum of its group (k,) int."""
    return values / np.bincount(group, values)[group]

"""Heat in rock and tool: friction, conduction, exchange across contacts, convection from the free surface."""
import math
import numpy as np

from rockwear.engines.base import Engine
from rockwear.kernels.free_surface import free_surface
from rockwear.kernels.surface_recession import neighbours, receded
from rockwear.kernels.voronoi import among, conducting


class Heat(Engine):
    """One HeatNetwork over rock particles (nodes 0..n-1) and tool particles (n..n+m-1), staggered with the mechanics.

    Friction heat chi W is shared between tool and rock, W being the work of irreversible slip ([Rojek 2014, eqs. 36-41]); between rock
    particles in halves. A tool and a rock particle that touch exchange h A (T_tool - T_rock) ([Rojek 2014, eq. 66]) for the seconds
    they touched, A = 2 r b of the tool particle, as the exact exchange of the two lumps, which cannot overshoot.
    Convection acts on the free surface ([Rojek 2014, eq. 42]), found anew when bonds have broken or particles have gone.

    network: kernels.conduction.HeatNetwork; bonds, rock_friction, tool_contact: engines; rock, tool: the specimen and
    the tool; tool_share: part of the heat of tool-rock friction that the tool takes; rock_paths,
    tool_paths: the pairs (m, 2) of particles that exchange heat within rock and tool, and their conductances (m,) W/K;
    conduction: False leaves all heat where it arises;
    acceleration: of the wear; a particle that it wears away takes 1 / acceleration of its heat along, the rest stays with
    those under it (kernels.receding);
    shank_temperature: K at which the shank holds the tool's fixed particles, None where they are insulated;
    time_scale: a function giving the seconds of the process in a second of the mechanics ([Rojek 2003, 12.1]), in which heat flows.
    """

    name = "heat"

    def __init__(self, *, network, bonds, rock_friction, tool_contact, rock, tool, heat_fraction, tool_share,
                 contact_conductance, convection, ambient, rock_paths, tool_paths, surface_period,
                 wear_acceleration=1.0, conduction=True, shank_temperature=None, time_scale=lambda: 1.0, period=1):
        super().__init__(period=period)
        self.network, self.bonds, self.rock_friction, self.tool_contact = network, bonds, rock_friction, tool_contact
        self.rock, self.tool, self.n = rock, tool, rock.count
        self.heat_fraction, self.tool_share, self.conduction = heat_fraction, tool_share, conduction
        self.contact_conductance, self.convection, self.ambient = contact_conductance, convection, ambient
        self.rock_paths, self.tool_paths = rock_paths, tool_paths
        self.under, self.handed = neighbours(tool_paths[0], tool.count), 1 - 1 / max(wear_acceleration, 1.0)
        self.facing = ~among(rock_paths[0], bonds.pairs, self.n)
        self.surface_period, self.shank_temperature, self.time_scale = surface_period, shank_temperature, time_scale
        self.replaced = self.renewed = 0.0
        self.surface_time = -math.inf
        self.clock = 0.0
        self.exchanged_with = {}
        self.tool_capacity = network.capacity[self.n:]
        self.start_average()

    def act(self):
        elapsed = self.elapsed() * self.time_scale()
        self.clock += elapsed
        self.averaged["seconds"] += elapsed
        self.network.add_heat(self._sources())
        if self.conduction:
            self.network.advance(elapsed)
            if self.clock - self.surface_time >= self.surface_period:
                self.find_surfaces()

    def leave_rock(self):
        """Nothing touches the tool any more: all of its surface is free."""
        self.exchanged_with = {}
        if self.conduction:
            self.find_surfaces()

    def cool(self, seconds):
        """Heat alone, for so many seconds of the process in which the mechanics stand still."""
        self.clock += seconds
        if self.conduction:
            self.network.advance(seconds)

    def _sources(self):
        """(n + m,) J that friction and the exchange between tool and rock bring since the last call."""
        tool_work, rock_work, touching = self.tool_contact.take_heating()
        rock = (1 - self.tool_share) * rock_work + self.rock_friction.take_work()
        heat = self.heat_fraction * np.concatenate([rock, self.tool_share * tool_work])
        self.averaged["friction_heat"] += heat[self.n:]
        self.exchanged_with = touching
        if touching and self.conduction:
            pairs = np.array(sorted(touching))
            seconds = self.time_scale() * np.array([touching[i, j] for i, j in pairs.tolist()])
            self._exchange(heat, self.n + pairs[:, 0], pairs[:, 1], seconds)
        return heat

    def _exchange(self, heat, tool, rock, seconds):
        capacity, temperature = self.network.capacity, self.network.temperature
        there = capacity[tool] > 0
        tool, rock, seconds = tool[there], rock[there], seconds[there]
        lumped = capacity[tool] * capacity[rock] / (capacity[tool] + capacity[rock])
        conductance = self.contact_conductance * 2 * self.tool.radii[tool - self.n]
        for name, weight in (("contact", 1.0), ("contact_kelvin", temperature[rock])):
            self.averaged[name] += np.bincount(tool - self.n, conductance * seconds * weight, self.tool.count)
        moved = (temperature[tool] - temperature[rock]) * lumped * -np.expm1(-conductance * seconds / lumped)
        heat += np.bincount(rock, moved, heat.size) - np.bincount(tool, moved, heat.size)

    def find_surfaces(self):
        """Contacts that conduct and surfaces that convect, as they are now."""
        self.surface_time = self.clock
        self.rock_friction.find_contacts()
        rock, tool = self._rock_now(), self._tool_now()
        self.network.rewire(edges=np.concatenate([rock[0], tool[0] + self.n]),
                            conductance=np.concatenate([rock[1], tool[1]]))
        in_contact = np.zeros(self.n + self.tool.count, bool)
        for index, rock in self.exchanged_with:
            in_contact[[self.n + index, rock]] = True
        self._expose(in_contact)

    def _rock_now(self):
        """Rock particles in contact conduct, and those across closed pores; contacts made since as a mean of all."""
        pairs, conductance = self.rock_paths
        loose = np.sort(np.array([(i.id1, i.id2) for i in self.rock_friction.contacts], int).reshape(-1, 2), axis=1)
        touching = np.concatenate([self.bonds.pairs[self.bonds.in_contact()], loose])
        conducts = conducting(pairs, among(pairs, touching, self.n), self.facing, self.n)
        met = loose[~among(loose, pairs, self.n)]
        return (np.concatenate([pairs[conducts], met]),
                np.concatenate([conductance[conducts], np.full(len(met), conductance.mean())]))

    def _tool_now(self):
        pairs, conductance = self.tool_paths
        alive = self.tool.erosion.alive[pairs].all(axis=1)
        return pairs[alive], conductance[alive]

    def _expose(self, in_contact):
        exposed = np.zeros(self.n + self.tool.count)
        exposed[:self.n] = free_surface(positions=self.rock.current_positions(), radii=self.rock.radii)
        alive = np.flatnonzero(self.tool.erosion.alive)
        if len(alive):
            exposed[self.n + alive] = free_surface(positions=self.tool.positions[alive], radii=self.tool.radii[alive])
        exposed[:self.n][self.rock.fixed] = 0.0
        exposed[self.n:][self.tool.fixed] = 0.0
        exposed[in_contact] = 0.0
        present = np.flatnonzero(self.network.present)
        self.network.convect(present, self.convection * exposed[present], self.ambient)

    def remove(self, worn, loose=()):
        """Tool particles are gone: `worn` ones have left the heat of accelerated wear behind, `loose` ones take theirs."""
        # The heat of their last friction comes first.
        self.network.add_heat(self._sources())
        network, there = self.network, self.network.temperature[self.n:]
        kept = receded(temperature=there, capacity=network.capacity[self.n:], adjacent=self.under, leaving=worn,
                       share=self.handed)
        network.add_heat(network.capacity * np.concatenate([np.zeros(self.n), kept - there]))
        network.remove(self.n + np.array([*worn, *loose], int))

    def replace_rock(self, temperature):
        """New rock at the start of a cycle: its particles take these (n,) K, and the difference is booked apart."""
        change = np.zeros(self.network.temperature.size)
        change[:self.n] = (temperature - self.network.temperature[:self.n]) * self.network.capacity[:self.n]
        self.replaced += float(change.sum())
        self.network.add_heat(change)

    def renew_tool(self, temperature):
        """A whole tool of (m,) K in place of the one that is there; what it holds more or less is booked apart."""
        before, state = self.network.heat_content, self.network.state()
        state["capacity"][self.n:], state["temperature"][self.n:] = self.tool_capacity, temperature
        state["fixed"][self.n:] = False
        self.network.restore(state)
        self.renewed += self.network.heat_content - before
        self._hold_shank()

    def _hold_shank(self):
        if self.shank_temperature is not None:
            self.network.fix(self.n + np.flatnonzero(self.tool.fixed), self.shank_temperature)

    def start_average(self):
        """Forget what `averages` has gathered."""
        self.averaged = {"seconds": 0.0, **{name: np.zeros(self.tool.count)
                                            for name in ("friction_heat", "contact", "contact_kelvin")}}

    def averages(self):
        """Of each tool particle since `start_average`: friction heat, W; conductance to the rock it touched, W/K; and
        the rock's temperature there, K (that of the air where it touched none); three arrays (m,)."""
        found, seconds = self.averaged, self.averaged["seconds"]
        touched = found["contact"] > 0
        rock = np.divide(found["contact_kelvin"], found["contact"], out=np.full(self.tool.count, self.ambient), where=touched)
        return found["friction_heat"] / seconds, found["contact"] / seconds, rock

    def tool_temperature(self):
        """(m,) K of the tool's particles."""
        return self.network.temperature[self.n:]

    def balance(self):
        """The heat book in J, signed as it changes what rock and tool hold; residual is what it fails to explain."""
        balance = self.network.balance
        balance["generated"] -= self.replaced
        balance["rock_replaced"] = self.replaced
        balance["tool_renewed"] = self.renewed
        balance["stored"] = self.network.heat_content - self.initial_content
        balance["residual"] = balance["stored"] - math.fsum(v for k, v in balance.items() if k != "stored")
        return balance

    def begin(self):
        """Take stock before the first step."""
        self._hold_shank()
        self.initial_content = self.network.heat_content - self.network.balance["into_fixed"]
        if self.conduction:
            self.find_surfaces()

    def state(self):
        network = self.network.state()
        return {"network": network, "replaced": self.replaced, "clock": self.clock,
                "surface_time": self.surface_time, "initial_content": self.initial_content, "renewed": self.renewed,
                "averaged": {name: np.copy(value) for name, value in self.averaged.items()},
                "touched": np.array(sorted(self.exchanged_with), int).reshape(-1, 2)}

    def restore(self, state):
        self.network.restore(state["network"])
        for name in ("replaced", "renewed", "clock", "surface_time", "initial_content"):
            setattr(self, name, float(state[name]))
        self.averaged = {name: np.copy(value) for name, value in state["averaged"].items()}
        self.exchanged_with = {(int(i), int(j)): 0.0 for i, j in state["touched"].tolist()}

    def log(self):
        alive = self.tool.erosion.alive
        temperature = self.network.temperature
        hottest = float(temperature[self.n:][alive].max()) if alive.any() else math.nan
        return {"tool_temperature_max": (hottest, "K"), "rock_temperature_max": (float(temperature[:self.n].max()), "K")}

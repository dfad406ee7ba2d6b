"""Heat in a network of particles: each particle has one temperature, each contact one conductance.

The lumped heat balance [Rojek 2014, eqs. 32-35], [Rojek 2003, eqs. 7.1-7.3], integrated by the explicit forward Euler
scheme [Rojek 2014, eq. 54]. Quantities of plane models are per metre of thickness.
"""
import math
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix, diags
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import ArpackNoConvergence, eigsh, splu
from scipy.spatial import cKDTree

from rockwear.kernels.voronoi import cells
from rockwear.kernels.checks import ParameterError, not_negative, positive, require

STEFAN_BOLTZMANN = 5.670374419e-8  # W/(m^2 K^4)

# Euler steps are half the stable step. Up to there no node passes the mean of its neighbours, so that a peak never
# overshoots and no mode changes sign; and the time error of long waves is of the size of the network's error in space
# (on a chain they nearly cancel: a dt/l^2 = 1/4, where 1/6 is best).
STEP_FRACTION = 0.5

HOTTEST = 0.01  # part of the mass whose mean temperature stands beside that of the hottest particle

PATHS = "voronoi", "fitted", "bar", "half_bar"  # models of conduction between particles, see paths()

_DENSE = 100  # nodes up to which a dense eigenvalue is quicker than Lanczos
_LANCZOS_TOLERANCE = 1e-5
_STATE = ("capacity", "temperature", "edges", "conductance", "fixed", "power", "convection", "ambient", "radiation",
          "surroundings", "balance")
_ENTRIES = ("generated", "convected", "radiated", "into_fixed", "removed")


class HeatNetwork:
    """Particles that store heat and contacts that conduct it.

        C_i dT_i/dt = P_i - sum_j H_ij (T_i - T_j) - hA_i (T_i - Ta_i) - sigma eA_i (T_i^4 - Ts_i^4)

    [Rojek 2014, eqs. 32-35 and 42], [Rojek 2003, eqs. 7.1-7.3]; the radiation of [Rojek 2003, 7.2] written out.

    Parameters (keyword only)
    capacity     (n,) m*c of each particle, J/K, greater than 0
    edges        (m, 2) int, the two particles of each contact; a contact given twice conducts twice
    conductance  (m,) or scalar, H of [Rojek 2014, eq. 35], W/K, at least 0
    temperature  (n,) or scalar, K. Without radiation the equations are linear, and temperature differences serve
                 as well.

    `nodes` is an index, a list of indices or a boolean mask over all n, each node at most once; the values that belong
    to them are scalars or one per node. Every broken rule raises ParameterError.
    """

    def __init__(self, *, capacity, edges, conductance, temperature):
        self._capacity = np.atleast_1d(_array("capacity", capacity, "J/K")).copy()
        require(self._capacity.ndim == 1 and self._capacity.size > 0, "capacity", self._capacity.shape,
                "one number a node", "shape")
        _refuse("capacity", self._capacity, self._capacity <= 0, "greater than 0", "J/K")
        n = self._capacity.size
        self._keep(_spread("temperature", temperature, n, "K").copy())
        self._fixed = np.zeros(n, bool)
        self._power = np.zeros(n)
        self._convection, self._ambient = np.zeros(n), np.zeros(n)
        self._radiation, self._surroundings = np.zeros(n), np.zeros(n)
        self._balance = dict.fromkeys(_ENTRIES, 0.0)
        self.rewire(edges=edges, conductance=conductance)

    # ---- state

    @property
    def temperature(self):
        """(n,) K, read only; a removed node keeps its last temperature."""
        return self._temperature

    @property
    def capacity(self):
        """(n,) J/K, a copy; 0 marks a removed node."""
        return self._capacity.copy()

    @property
    def present(self):
        """(n,) bool, False where a node was removed."""
        return self._capacity > 0

    @property
    def edges(self):
        """(m, 2) int, the present contacts, a copy."""
        return self._edges.copy()

    @property
    def conductance(self):
        """(m,) W/K of the contacts, a copy."""
        return self._conductance.copy()

    @property
    def heat_content(self):
        """Heat of all present nodes, sum C_i T_i, J, counted from 0 K."""
        return float(self._capacity @ self._temperature)

    @property
    def balance(self):
        """Heat that the network has gained since it was made, J, by origin; a loss is negative.

            generated   by source() and add_heat()
            convected   from the ambient of convect()
            radiated    from the surroundings of radiate()
            into_fixed  supplied to hold the nodes of fix() at their temperature
            removed     minus the heat of the nodes that remove() took out

        The change of heat_content is the sum of these, to round-off. Conduction moves heat between nodes and has no
        entry.
        """
        return dict(self._balance)

    # ---- loads and boundary conditions

    def fix(self, nodes, kelvin):
        """Hold `nodes` at the temperature `kelvin` from now on [Rojek 2003, eq. 7.4]."""
        nodes = _nodes(nodes, self._capacity)
        kelvin = _spread("kelvin", kelvin, nodes.size, "K")
        temperature = self._temperature.copy()
        self._balance["into_fixed"] += float(self._capacity[nodes] @ (kelvin - temperature[nodes]))
        temperature[nodes] = kelvin
        self._fixed[nodes] = True
        self._keep(temperature)
        self._prepare()

    def source(self, nodes, watt):
        """Set the heat power of `nodes`, W, in place of the previous one (Q_ext of [Rojek 2014, eq. 33])."""
        nodes = _nodes(nodes, self._capacity)
        self._power[nodes] = _spread("watt", watt, nodes.size, "W")

    def convect(self, nodes, watt_per_kelvin, ambient):
        """Set the convection of `nodes` in place of the previous one (Newton's law, [Rojek 2014, eq. 42]).

        watt_per_kelvin  coefficient times free area, h*A, W/K, at least 0
        ambient          temperature of the medium, K
        """
        nodes = _nodes(nodes, self._capacity)
        coefficient = _spread("watt_per_kelvin", watt_per_kelvin, nodes.size, "W/K")
        _refuse("watt_per_kelvin", coefficient, coefficient < 0, "at least 0", "W/K")
        self._ambient[nodes] = _spread("ambient", ambient, nodes.size, "K")
        self._convection[nodes] = coefficient
        self._prepare()

    def radiate(self, nodes, area_times_emissivity, ambient):
        """Set the radiation of `nodes`, sigma*e*A*(T^4 - Ts^4), in place of the previous one [Rojek 2003, 7.2].

        area_times_emissivity  free area times emissivity, m^2, at least 0
        ambient                temperature of the surroundings, K, at least 0; here temperatures are absolute
        """
        nodes = _nodes(nodes, self._capacity)
        area = _spread("area_times_emissivity", area_times_emissivity, nodes.size, "m^2")
        _refuse("area_times_emissivity", area, area < 0, "at least 0", "m^2")
        surroundings = _spread("ambient", ambient, nodes.size, "K")
        _refuse("ambient", surroundings, surroundings < 0, "at least 0", "K")
        _refuse("temperature", self._temperature[nodes], self._temperature[nodes] < 0, "at least 0", "K")
        self._surroundings[nodes] = surroundings
        self._radiation[nodes] = area
        self._prepare()

    def add_heat(self, joules_by_node):
        """Add `joules_by_node`, (n,) J, at once: `generated`, say by friction since the last call [Rojek 2014, eq. 36].

        A fixed node passes it to what holds the node. A removed node takes none.
        """
        joules = _array("joules_by_node", joules_by_node, "J")
        require(joules.shape == self._capacity.shape, "joules_by_node", joules.shape, "one number a node", "shape")
        _refuse("joules_by_node", joules, (self._capacity == 0) & (joules != 0), "0 at a removed node", "J")
        self._balance["generated"] += float(joules.sum())
        self._balance["into_fixed"] -= float(joules[self._fixed].sum())
        self._keep(self._temperature + joules * self._response)

    def rewire(self, *, edges, conductance):
        """Replace all contacts: `edges` (m, 2) int and `conductance` (m,) or scalar, W/K, as in the constructor."""
        edges = _edges(edges, self._capacity.size)
        conductance = _spread("conductance", conductance, len(edges), "W/K").copy()
        _refuse("conductance", conductance, conductance < 0, "at least 0", "W/K")
        gone = self._capacity[edges] == 0
        require(not gone.any(), "edges", int(edges[gone][0]) if gone.any() else None, "between nodes still present")
        self._wire(edges, conductance)

    def remove(self, nodes):
        """Remove `nodes` with their contacts, sources and surfaces; return their heat, sum C*T, J.

        The balance has this heat as `removed`. The other nodes keep their indices.
        """
        nodes = _nodes(nodes, self._capacity)
        carried = float(self._capacity[nodes] @ self._temperature[nodes])
        self._balance["removed"] -= carried
        for values in (self._capacity, self._power, self._convection, self._radiation):
            values[nodes] = 0.0
        self._fixed[nodes] = False
        stays = (self._capacity[self._edges] > 0).all(axis=1)
        self._wire(self._edges[stays], self._conductance[stays])
        return carried

    # ---- time integration

    def stable_step(self):
        """Longest stable step of the Euler scheme, s: 2 / lambda_max(C^-1 K); inf where nothing can flow.

        K is the conduction matrix of the nodes that are not fixed plus hA on its diagonal. The eigenvalue is that of
        C^-1/2 K C^-1/2. Radiation adds the largest 4 sigma eA T^3 / C at the present temperatures (or at those of the
        surroundings, where hotter), an upper bound (Weyl). [Rojek 2014, eq. 57] estimates the limit of a chain; it
        prints l/(2a) for l^2/(2a).
        """
        return _step_of(self._rates.linear + self._rates.radiative(self._temperature))

    def advance(self, duration, step=None):
        """Integrate over `duration`, s, in equal Euler steps [Rojek 2014, eq. 54]; return their number.

        step  longest step allowed, s, at most the stable one (else ParameterError); by default STEP_FRACTION of it
        Where a node heats up and its radiation becomes stiffer, the remaining time is divided more finely. Raises
        FloatingPointError if the temperatures have left the range of numbers.
        """
        duration = not_negative("duration", duration, "s")
        if step is not None:
            step = positive("step", step, "s")
            if not self._rates.allow(step, 1.0, self._temperature):
                raise ParameterError("step", step, f"at most the stable step, {self.stable_step():g}", "s")
        share = STEP_FRACTION if step is None else 1.0
        if duration == 0:
            return 0
        if step is None and not self._rates.allow(duration, share, self._temperature):
            step = share * self.stable_step()
        left = 1 if step is None else math.ceil(duration / step * (1 - 1e-12))  # round-off is not worth a step
        count, radiates = 0, self._rates.glowing.size > 0
        while left:
            flows = self._flows(self._temperature)
            gains = sum(flows)
            if not math.isfinite(gains.sum()):
                raise FloatingPointError("the temperatures are no longer finite numbers")
            rise = gains * self._response
            while radiates and not self._rates.allow(duration / left, share,
                                                     self._temperature + duration / left * rise):
                left *= 2
            dt = duration / left
            self._enter(dt, flows, gains)
            self._keep(self._temperature + dt * rise)
            duration, left, count = duration - dt, left - 1, count + 1
        return count

    def steady_state(self):
        """Stationary temperatures, (n,) K, with the present sources, surfaces and fixed nodes.

        A part of the network that is not fixed anywhere and neither convects nor radiates keeps its heat; raises
        ParameterError if sources feed such a part. Newton's iteration solves radiation.
        """
        return _steady_state(self)

    def state(self):
        """What restore() needs, a dict of new numpy arrays."""
        kept = {name: np.array(getattr(self, "_" + name)) for name in _STATE if name != "balance"}
        return {**kept, "balance": np.array([self._balance[name] for name in _ENTRIES])}

    def restore(self, state):
        """Set a `state()` of a network with as many nodes; what follows is equal bit for bit."""
        require(set(state) == set(_STATE), "state", sorted(state), f"with the entries {sorted(_STATE)}")
        for name in _STATE:
            shape, expected = np.shape(state[name]), np.shape(getattr(self, "_" + name))
            if name in ("edges", "conductance"):
                expected = (len(state["edges"]),) + expected[1:]
            if name == "balance":
                expected = (len(_ENTRIES),)
            require(shape == expected, f"state['{name}']", shape, f"of shape {expected}")
        for name in ("capacity", "fixed", "power", "convection", "ambient", "radiation", "surroundings"):
            setattr(self, "_" + name, np.array(state[name]))
        self._balance = dict(zip(_ENTRIES, map(float, state["balance"])))
        self._keep(np.array(state["temperature"]))
        self.rewire(edges=state["edges"], conductance=state["conductance"])

    # ---- internals

    def _keep(self, temperature):
        # A new array each time, so that the array a caller holds stays as it was.
        temperature.flags.writeable = False
        self._temperature = temperature

    def _wire(self, edges, conductance):
        n, (i, j) = self._capacity.size, edges.T
        self._edges, self._conductance = edges, conductance
        diagonal = np.bincount(i, conductance, n) + np.bincount(j, conductance, n)
        own = np.arange(n)
        self._conduction = csr_matrix((np.concatenate([-conductance, -conductance, diagonal]),
                                       (np.concatenate([i, j, own]), np.concatenate([j, i, own]))), shape=(n, n))
        self._conduction.eliminate_zeros()  # a contact of conductance 0 joins nothing
        self._prepare()

    def _prepare(self):
        """Update what depends on contacts, fixed nodes and surfaces."""
        free = (self._capacity > 0) & ~self._fixed
        self._response = np.divide(1.0, self._capacity, out=np.zeros(free.size), where=free)
        self._rates = _Rates(conduction=self._conduction, convection=self._convection, response=self._response,
                             radiation=self._radiation, surroundings=self._surroundings)

    def _flows(self, temperature):
        """Heat flowing into each node, W: generated, conducted, convected and, where any, radiated."""
        flows = [self._power, -(self._conduction @ temperature), self._convection * (self._ambient - temperature)]
        if self._rates.glowing.size:
            radiated, glowing = np.zeros(temperature.size), self._rates.glowing
            fourth = self._surroundings[glowing]**4 - temperature[glowing]**4
            radiated[glowing] = STEFAN_BOLTZMANN * self._radiation[glowing] * fourth
            flows.append(radiated)
        return flows

    def _enter(self, dt, flows, gains):
        generated, _, convected, *radiated = flows
        self._balance["generated"] += dt * float(generated.sum())
        self._balance["convected"] += dt * float(convected.sum())
        for flow in radiated:
            self._balance["radiated"] += dt * float(flow.sum())
        self._balance["into_fixed"] -= dt * float(gains[self._fixed].sum())


class _Rates:
    """Rates of decay, 1/s, that limit the Euler step: `linear`, the largest eigenvalue of C^-1 K of the free nodes,
    computed once when it is asked for; `bound` above it; radiative(temperature), to be added to either.

    conduction: (n, n) sparse, W/K; convection: (n,) W/K; response: (n,) 1/C, K/J, 0 for fixed and removed nodes;
    radiation: (n,) eA, m^2; surroundings: (n,) K.
    """

    def __init__(self, *, conduction, convection, response, radiation, surroundings):
        self.conduction, self.convection, self.response = conduction, convection, response
        self.glowing = np.flatnonzero(radiation)  # few, and powers of temperature are expensive
        self.radiation, self.surroundings = radiation[self.glowing], surroundings[self.glowing]
        # Gershgorin: no eigenvalue lies above the largest row sum of absolute values.
        self.bound = float(((2 * conduction.diagonal() + convection) * response).max())

    @cached_property
    def linear(self):
        if not self.bound > 0:
            return 0.0
        free = np.flatnonzero(self.response > 0)
        scale = diags(np.sqrt(self.response[free]))
        matrix = (self.conduction + diags(self.convection)).tocsr()[free][:, free]
        matrix = scale @ matrix @ scale
        if free.size <= _DENSE:
            return float(np.linalg.eigvalsh(matrix.toarray())[-1])
        try:  # a start of fixed seed, so that a repeated run divides its time alike
            start = np.random.default_rng(1).standard_normal(free.size)
            largest = eigsh(matrix, k=1, which="LA", v0=start, tol=_LANCZOS_TOLERANCE, return_eigenvectors=False)
            return min(float(largest[0]) * (1 + _LANCZOS_TOLERANCE), self.bound)
        except ArpackNoConvergence:
            return self.bound

    def radiative(self, temperature):
        if not self.glowing.size:
            return 0.0
        hotter = np.maximum(temperature[self.glowing], self.surroundings)
        stiffness = 4 * STEFAN_BOLTZMANN * self.radiation * hotter**3
        return float((stiffness * self.response[self.glowing]).max())

    def allow(self, dt, share, temperature):
        """Whether `dt` is within `share` of the stable step; the bound mostly saves the eigenvalue."""
        radiative = self.radiative(temperature)
        return (dt <= share * _step_of(self.bound + radiative)
                or dt <= share * _step_of(self.linear + radiative))


def bar_conductance(conductivity, thickness):
    """Conductance of a contact as a bar between two centres, H = lambda A / l = lambda b, W/K [Rojek 2014, eqs. 64-65].

    conductivity  lambda, W/(m K), greater than 0
    thickness     b, m, greater than 0: 1 in the plane; 2r between equal spheres, which gives the exact conductivity of
                  their simple cubic lattice

    The bar is as wide as it is long (2r by 2r), so that the radius cancels in the plane. [Rojek 2003, eq. 11.1] takes a
    bar only r wide, with half the conductance. Neither considers the packing: see calibrated_conductance. Raises
    ParameterError.
    """
    return positive("conductivity", conductivity, "W/(m K)") * positive("thickness", thickness, "m")


def paths(model, conductivity, *, pairs, cells, fitted, thickness=1.0):
    """The pairs of a packing that exchange heat, and their conductances: (m, 2) int, (m,) W/K.

    model         "voronoi": neighbours by the faces of their Voronoi cells, lambda A/d [Rojek 2003, eq. 7.3] with the
                  face as area
                  "fitted": the contacts, with one conductance that gives the packing the wanted conductivity
                  "bar", "half_bar": the contacts as bars between two centres [Rojek 2014, eqs. 64-65], [Rojek 2003,
                  eq. 11.1]: bar_conductance, and half of it
    conductivity  lambda, W/(m K), greater than 0, or ParameterError
    pairs         (m, 2) int, the contacts
    cells         a function that gives kernels.voronoi.Cells
    fitted        a function that gives W/K, as calibrated_conductance does
    thickness     of the bars, m: 1 in the plane, 2r between equal spheres
    """
    require(model in PATHS, "model", model, f"one of {', '.join(PATHS)}")
    if model == "voronoi":
        found = cells()
        return found.edges, found.conductance(conductivity)
    parts = {"bar": 1.0, "half_bar": 0.5}
    each = fitted() if model == "fitted" else bar_conductance(conductivity, thickness) * parts[model]
    return pairs, np.full(len(pairs), each)


def effusivity(conductivity, density, specific_heat):
    """Thermal effusivity e = sqrt(lambda*rho*c), W s^0.5/(m^2 K) [Rojek 2014, eq. 40].

    conductivity in W/(m K), density in kg/m^3, specific_heat in J/(kg K), each greater than 0; or ParameterError.
    """
    return math.sqrt(positive("conductivity", conductivity, "W/(m K)") * positive("density", density, "kg/m^3")
                     * positive("specific_heat", specific_heat, "J/(kg K)"))


def effusivity_share(e_i, e_j):
    """Share of the friction heat that goes into body i, alpha = e_i/(e_i + e_j) [Rojek 2014, eqs. 39, 41].

    e_i, e_j  effusivities of the two bodies, W s^0.5/(m^2 K), greater than 0; or ParameterError.
    """
    e_i, e_j = positive("e_i", e_i, "W s^0.5/(m^2 K)"), positive("e_j", e_j, "W s^0.5/(m^2 K)")
    return e_i / (e_i + e_j)


def hot_and_mean(network, first):
    """Mean temperatures (K) of the hottest part of the mass of the nodes from `first` on, HOTTEST of it or at least the
    heaviest node's, and of all of it.

    Where no node becomes colder, neither does the part: it is as heavy whatever the order.
    """
    order = first + np.argsort(-network.temperature[first:])
    capacity, temperature = network.capacity[order], network.temperature[order]
    part = max(HOTTEST * capacity.sum(), capacity.max())
    hottest = np.clip(part - (np.cumsum(capacity) - capacity), 0.0, capacity)
    return tuple(float(np.average(temperature, weights=weights)) for weights in (hottest, capacity))


def effective_conductivity(*, positions, edges, conductance):
    """Conductivity of a packing of particles as one material, (d,) W/(m K), one value per direction.

    positions    (n, d) m, d = 2 (conductances per metre of thickness) or 3, filling a box along the axes
    edges        (m, 2) int
    conductance  (m,) or scalar, W/K

    For each direction the outer tenths of the specimen, and all particles whose cells reach its ends, are held at a
    linear temperature; the steady state is solved. Flux density and gradient are both taken from the middle 60 % in
    every direction, so that neither the held strips nor the free sides influence the result:

        lambda = -q/g,   q = sum_i 1/2 sum_j Q_ij (x_j - x_i) / sum_i V_i,

    with the heat flows Q_ij, the Voronoi volumes V_i and the gradient g of a plane fitted to the temperatures. On
    regular lattices this is exact: sqrt(3)*H for triangles, H for squares, H/D for cubes. The sources have no such
    formula; [Rojek 2014, after eq. 65] asks for the relation. Raises ParameterError.
    """
    positions = _array("positions", positions, "m")
    require(positions.ndim == 2 and positions.shape[1] in (2, 3), "positions", positions.shape, "(n, 2) or (n, 3)",
            "shape")
    n, dimension = positions.shape
    edges = _edges(edges, n)
    i, j = edges.T
    conductance = _spread("conductance", conductance, len(edges), "W/K")
    low, extent = positions.min(axis=0), np.ptp(positions, axis=0)
    place = (positions - low) / np.where(extent > 0, extent, 1.0)
    inner = np.flatnonzero((abs(place - 0.5) < 0.3).all(axis=1))
    require((extent > 0).all(), "positions", extent.tolist(), "spread out in every direction", "m")
    require(inner.size > dimension, "positions", f"{n} nodes", f"more than {dimension} in the middle of the specimen")
    rim = 0.5 * np.median(cKDTree(positions).query(positions, 2)[0][:, 1])
    whole = cells(positions - low + rim, box=extent + 2 * rim)
    volume = whole.volumes[inner].sum()
    plane = np.column_stack([positions[inner] - positions[inner].mean(axis=0), np.ones(inner.size)])

    conductivity = np.empty(dimension)
    for axis in range(dimension):
        network = HeatNetwork(capacity=np.ones(n), edges=edges, conductance=conductance, temperature=place[:, axis])
        strips = abs(place[:, axis] - 0.5) >= 0.4
        for end in (2 * axis, 2 * axis + 1):
            strips[whole.walls[end][0]] = True
        network.fix(strips, place[strips, axis])
        temperature = network.steady_state()
        flow = conductance * (temperature[i] - temperature[j])
        moment = 0.5 * flow * (positions[j, axis] - positions[i, axis])
        moved = np.bincount(edges.ravel(), np.repeat(moment, 2), n)[inner].sum()
        gradient = np.linalg.lstsq(plane, temperature[inner], rcond=None)[0][axis]
        require(gradient > 0, "edges", len(edges), "enough to carry heat across the specimen")
        conductivity[axis] = -moved / volume / gradient
    return conductivity


def calibrated_conductance(*, positions, edges, conductance, conductivity):
    """Conductances, all scaled by one factor, that give the packing the wanted conductivity: (m,) W/K.

    The packing's own conductivity, the mean of effective_conductivity over the directions, is proportional to the
    conductances, so that one solution gives the factor. `conductivity` in W/(m K), greater than 0; the others as in
    effective_conductivity. Raises ParameterError.
    """
    conductivity = positive("conductivity", conductivity, "W/(m K)")
    own = effective_conductivity(positions=positions, edges=edges, conductance=conductance).mean()
    require(own > 0, "conductance", float(own), "enough to conduct across the specimen", "W/(m K)")
    return _spread("conductance", conductance, len(edges), "W/K") * (conductivity / own)


def _steady_state(network):
    """HeatNetwork.steady_state."""
    free = network._response > 0
    count, part = connected_components(network._conduction, directed=False)
    holds = network._fixed | (network._convection > 0) | (network._radiation > 0)
    fixed = np.bincount(part, holds, count) > 0
    net = np.bincount(part, network._power, count)
    gross = np.bincount(part, abs(network._power), count)
    drifts = ~fixed & (abs(net) > 1e-12 * gross)
    require(not drifts.any(), "source", float(net[drifts][0]) if drifts.any() else 0.0,
            "0 in sum where no node is fixed, convects or radiates", "W")

    # The equations of an insulated part leave a constant open: one node is held for the solution, then the part is
    # shifted to its own heat.
    pinned = np.unique(part, return_index=True)[1][~fixed]
    free[pinned] = False
    free = np.flatnonzero(free)
    temperature = network._temperature.copy()
    hottest = max(1.0, abs(temperature).max())
    if network._rates.glowing.size:  # from below the first step may shoot far up, from above it cannot
        temperature[free] = hottest = max(hottest, network._surroundings.max())
    linear = network._conduction + diags(network._convection)
    for _ in range(200 if free.size else 0):
        stiffness = 4 * STEFAN_BOLTZMANN * network._radiation * temperature**3
        jacobian = (linear + diags(stiffness)).tocsc()[free][:, free]
        change = _factorised(jacobian).solve(sum(network._flows(temperature))[free])
        temperature[free] += change
        if not network._rates.glowing.size or abs(change).max() <= 1e-12 * hottest:
            break
    kept = np.bincount(part, network._capacity * network._temperature, count)
    now = np.bincount(part, network._capacity * temperature, count)
    capacity = np.bincount(part, network._capacity, count)
    shift = np.divide(kept - now, capacity, out=np.zeros(count), where=~fixed & (capacity > 0))
    return temperature + shift[part]


def _array(name, values, unit):
    try:
        values = np.asarray(values, float)
    except (TypeError, ValueError):
        raise ParameterError(name, values, "numbers", unit) from None
    _refuse(name, values, ~np.isfinite(values), "finite", unit)
    return values


def _spread(name, values, size, unit):
    values = _array(name, values, unit)
    require(values.ndim == 0 or values.shape == (size,), name, values.shape, f"one number or {size}", "shape")
    return np.broadcast_to(values, (size,))


def _refuse(name, values, broken, rule, unit=""):
    """Raise ParameterError with the first of the `values` that is `broken`."""
    if np.any(broken):
        raise ParameterError(name, values[broken].ravel()[0].item(), rule, unit)


def _nodes(nodes, capacity):
    nodes, n = np.asarray(nodes), capacity.size
    if nodes.dtype == bool:
        require(nodes.shape == (n,), "nodes", nodes.shape, f"a mask over {n} nodes", "shape")
        nodes = np.flatnonzero(nodes)
    nodes = np.atleast_1d(nodes if nodes.size else nodes.astype(int))
    require(nodes.dtype.kind in "iu" and nodes.ndim == 1, "nodes", nodes.dtype, "indices or a boolean mask")
    _refuse("nodes", nodes, (nodes < 0) | (nodes >= n), f"between 0 and {n - 1}")
    _refuse("nodes", nodes, capacity[nodes] == 0, "a node still present")
    require(np.unique(nodes).size == nodes.size, "nodes", f"{nodes.size} nodes", "given once each")
    return nodes


def _edges(edges, n):
    edges = np.asarray(edges)
    edges = edges.reshape(0, 2).astype(int) if edges.size == 0 else edges.copy()
    require(edges.ndim == 2 and edges.shape[1] == 2, "edges", edges.shape, "(m, 2)", "shape")
    require(edges.dtype.kind in "iu", "edges", edges.dtype, "indices")
    _refuse("edges", edges, (edges < 0) | (edges >= n), f"between 0 and {n - 1}")
    _refuse("edges", edges[:, 0], edges[:, 0] == edges[:, 1], "between two different nodes")
    return edges


def _step_of(rate):
    return 2.0 / rate if rate > 0 else math.inf


def _factorised(matrix):
    # Symmetric and positive definite: no pivoting, and an ordering that keeps the symmetry.
    return splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})

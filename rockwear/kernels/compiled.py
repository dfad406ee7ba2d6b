"""Loops over bonds and contacts of YADE, from where they lie in memory, compiled to machine code by numba.

Each is a function of arrays. `memory` is all memory of the process as numbers (engines.memory.MEMORY), and a place an
index into it. numpy takes a microsecond for each of its operations, for ten bonds as for one: these loops take as long
for all that is to be done with some bonds. Machine code is kept beside this file, or in the user's cache, and made anew
when this file changes. It would not be if another file did: what compiled functions call must therefore be here.
"""
import math

import numpy as np
from numba import njit


def compiled(function):
    """The function as machine code, kept for other runs where a folder can be written."""
    try:
        return njit(cache=True, error_model="numpy")(function)
    except RuntimeError:
        return njit(error_model="numpy")(function)


# ---- bonds of YADE's concrete model

BOND = ("normal", "increment", "normal_force", "shear_force", "strain", "slipped", "omega", "cohesion", "length", "E",
        "G", "onset", "fracture", "kappa", "crushed", "radius1", "radius2", "overlap")
"""What a table of the places of bonds holds, (30, m): three rows for each of the six vectors, one for each number."""
(NORMAL, INCREMENT, NORMAL_FORCE, SHEAR_FORCE, STRAIN, SLIPPED, OMEGA, COHESION, LENGTH, E, G, ONSET, FRACTURE, KAPPA,
 CRUSHED, RADIUS1, RADIUS2, OVERLAP) = (*range(0, 18, 3), *range(18, 30))
"""Rows of that table, of vectors the first one."""
LAW = "kn", "kt", "Rn", "Rt", "mu", "onset", "gone", "slip_end", "coupling", "Rc"
"""Attributes of a law of kernels.bond_laws.Cohesive that a table of laws holds, (10, m)."""
KN, KT, RN, RT, MU, OPEN_AT_PEAK, OPEN_AT_END, SLIP_END, COUPLING, RC = range(10)
"""Rows of that table."""
SPENT = 1.0 - 1e-6
"""Damage of a bond that slip has broken: YADE keeps it, as a contact with friction, until it opens."""
STRAIGHT = 10
"""Points on the path that a bond is taken to have come before the first look that finds it softened or slipped."""
CRUSHING_STRAIN = 0.01
"""Elastic compressive strain at which YADE lets all bonds crush."""


@compiled
def read(memory, place):
    """The vector at a place, a tuple."""
    return memory[place], memory[place + 1], memory[place + 2]


@compiled
def write(memory, place, x, y, z):
    """Set the vector at a place."""
    memory[place], memory[place + 1], memory[place + 2] = x, y, z


@compiled
def dot(a, b):
    """Of two vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compiled
def vanishes(a):
    """Whether a vector is 0."""
    return a[0] == 0.0 and a[1] == 0.0 and a[2] == 0.0


@compiled
def opening(softening, onset, gone):
    """Largest opening so far of a bond of this omega > 0; it, `onset` and `gone`, at the peak and at the end, in m or
    as strains."""
    return onset / (1.0 - softening * (1.0 - onset / gone))


@compiled
def softening_energy(softening, Rn, onset, gone):
    """Energy (J) that softening to this omega has dissipated. Rn: N, the strength; onset, gone: m, see `opening`."""
    u = opening(softening, onset, gone)
    # Under the curve up to u, less what unloading along the secant gives back.
    force = Rn * (gone - u) / (gone - onset)
    return 0.5 * (Rn * onset + (Rn + force) * (u - onset) - force * u)


@compiled
def set_damage(memory, where, n, omega):
    """CpmPhys.setDamage of a bond that can break: its damage, and the strain from which on it rises."""
    strain = opening(omega, memory[where[ONSET, n]], memory[where[FRACTURE, n]])
    memory[where[OMEGA, n]] = omega
    memory[where[KAPPA, n]] = strain if omega > 0.0 else 0.0


@compiled
def set_cohesion(memory, where, n, laws):
    """Set the cohesion of a bond in YADE, of which it takes the part 1 - omega, to Rt / (1 - q omega)."""
    memory[where[COHESION, n]] = laws[RT, n] / (1.0 - laws[COUPLING, n] * memory[where[OMEGA, n]])


@compiled
def set_damages(memory, where, numbers, omega):
    """`set_damage` of bonds (k,) to omega (k,)."""
    for k, n in enumerate(numbers):
        set_damage(memory, where, n, omega[k])


@compiled
def weaken(memory, where, numbers, laws):
    """`set_cohesion` of bonds (k,)."""
    for n in numbers:
        set_cohesion(memory, where, n, laws)


@compiled
def shear_forces(memory, where, status, separated, in_view):
    """Of the bonds that are `in_view` (m,) bool and not `separated` by their status (m,): numbers (l,) and shear forces
    (N) (l, 3)."""
    most = np.sum(in_view)
    numbers, found, count = np.empty(most, np.int64), np.empty((most, 3)), 0
    for n in range(len(status)):
        if in_view[n] and status[n] != separated:
            numbers[count] = n
            found[count, 0], found[count, 1], found[count, 2] = read(memory, where[SHEAR_FORCE, n])
            count += 1
    return numbers[:count], found[:count]


@compiled
def take_slip(memory, where, n, stiffness):
    """Take the slip out of YADE's shear strain of bond n and leave the elastic part, in the plane of the contact.
    stiffness: N, force over strain. -> the slip, a strain."""
    normal, force = read(memory, where[NORMAL, n]), read(memory, where[SHEAR_FORCE, n])
    along = dot(force, normal)
    x, y, z = force[0] - normal[0] * along, force[1] - normal[1] * along, force[2] - normal[2] * along
    length = math.sqrt(dot((x, y, z), (x, y, z)))
    # As long as the force, nearly in the plane of which it lies.
    scale = math.sqrt(dot(force, force)) / (-length * stiffness if length > 0.0 else 1.0)
    x, y, z = x * scale, y * scale, z * scale
    strain = read(memory, where[STRAIN, n])
    slip = strain[0] - x, strain[1] - y, strain[2] - z
    write(memory, where[STRAIN, n], x, y, z)
    write(memory, where[SLIPPED, n], 0.0, 0.0, 0.0)
    return math.sqrt(dot(slip, slip))


@compiled
def sample_slip(memory, where, numbers, before, status, separated, by_radii, laws, lengths, slid, dissipated, by_slip):
    """Take the slip of bonds (k,) in the last step out of their strains, and add it to `slid` (m,) m and its work to
    sums (m,) J. -> J, of all.

    before: (k, 3) N, see `shear_forces`, which is brought up to date; lengths: (m,) m. The work is the mean of the
    forces before and after the step times how far they moved, less what the spring stores of it. They moved by YADE's
    increment, where that is `by_radii` without the factor, radii over distance, of translations (kernels.stability).
    Bonds that are `separated` by their status (m,) are no longer in memory.
    """
    total = 0.0
    for k, n in enumerate(numbers):
        if status[n] == separated:
            continue
        force, force_before = read(memory, where[SHEAR_FORCE, n]), (before[k, 0], before[k, 1], before[k, 2])
        before[k, 0], before[k, 1], before[k, 2] = force
        # YADE leaves the slip of a bond without any shear strength as it is.
        if vanishes(read(memory, where[SLIPPED, n])) and not vanishes(force):
            continue
        scale = 1.0
        if by_radii:
            scale -= memory[where[OVERLAP, n]] / (memory[where[RADIUS1, n]] + memory[where[RADIUS2, n]])
        x, y, z = read(memory, where[INCREMENT, n])
        both = force[0] + force_before[0], force[1] + force_before[1], force[2] + force_before[2]
        work = -dot(both, (x * scale, y * scale, z * scale))
        stored = (dot(force, force) - dot(force_before, force_before)) / laws[KT, n]
        work = 0.5 * (work - stored)
        slid[n] += take_slip(memory, where, n, laws[KT, n] * lengths[n]) * lengths[n]
        dissipated[n] += work
        by_slip[n] += work
        total += work
    return total


@compiled
def exchanged(part, coupling):
    """Part of the shear strength that is left at the damage `part` < 1, and the damage at which so much is left."""
    return (1.0 - part) / (1.0 - coupling * part)


@compiled
def weak(laws, omega, status, separated, least):
    """(m,) bool, bonds of less than the part `least` of their shear strength, without those `separated` by their status
    (m,)."""
    found = np.zeros(len(omega), np.bool_)
    for n in range(len(omega)):
        found[n] = status[n] != separated and (
            omega[n] >= 1.0 or exchanged(omega[n], laws[COUPLING, n]) < least)
    return found


@compiled
def shear_limit(memory, where, n, laws):
    """Shear force (N) that bond n bears now."""
    omega = memory[where[OMEGA, n]]
    left = exchanged(omega, laws[COUPLING, n]) if omega < 1.0 else 0.0
    Fn = -dot(read(memory, where[NORMAL_FORCE, n]), read(memory, where[NORMAL, n]))
    return max(left * laws[RT, n] - laws[MU, n] * Fn, 0.0)


@compiled
def harden(memory, where, n, laws, hardening, strains, lengths):
    """Take note of YADE's plastic strain of bond n, and let its crushing strength grow. -> work, J.

    The reference length grows so that CRUSHING_STRAIN of it is the new strength (Rc + h kn up)/kn, and what is
    constant in metres, or as a force, stays so.
    """
    strain, kn, length = memory[where[CRUSHED, n]], laws[KN, n], lengths[n]
    work = kn * CRUSHING_STRAIN * length**2 * (strains[n] - strain)
    grown = (laws[RC, n] / (kn * length) - hardening * strain) / CRUSHING_STRAIN
    for row in (LENGTH, E, G):
        memory[where[row, n]] *= grown
    for row in (ONSET, FRACTURE, KAPPA, CRUSHED):
        memory[where[row, n]] /= grown
    for row in (STRAIN, SLIPPED):
        for along in range(3):
            memory[where[row + along, n]] /= grown
    # As a restart reads them.
    lengths[n], strains[n] = memory[where[LENGTH, n]], memory[where[CRUSHED, n]]
    return work


@compiled
def soften(n, before, now, laws, dissipated):
    """Add what bond n dissipated as its damage rose to the sum (m,) J. -> J."""
    Rn, onset, end = laws[RN, n], laws[OPEN_AT_PEAK, n], laws[OPEN_AT_END, n]
    work = softening_energy(min(now, 1.0), Rn, onset, end) - softening_energy(before, Rn, onset, end)
    dissipated[n] += work
    return work


@compiled
def slip_work(n, laws, hardening, un, ut):
    """Work (J) against the shear force of new bond n on a straight path to the opening un and the shift ut (m), by the
    law of kernels.bond_laws.Cohesive; hardening: its h."""
    kn, kt, mu, Rc, coupling = laws[KN, n], laws[KT, n], laws[MU, n], laws[RC, n], laws[COUPLING, n]
    onset, end_of_slip = laws[OPEN_AT_PEAK, n], laws[SLIP_END, n]
    omega, shortened, slip, before, work = 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(1, STRAIGHT + 1):
        u = un * k / STRAIGHT
        opened = u - shortened
        if opened > onset and omega < 1.0:
            omega = min(max(omega, (1.0 - onset / opened) / (1.0 - onset / laws[OPEN_AT_END, n])), 1.0)
        if kn * opened < hardening * kn * shortened - Rc:
            shortened = (u + Rc / kn) / (1.0 + hardening)
        Ft = kt * (ut * k / STRAIGHT - slip)
        if omega < 1.0:
            Fn = kn * (u - shortened) * (1.0 - omega if opened > 0.0 else 1.0)
            left = exchanged(omega, coupling)
            limit = max(left * laws[RT, n] - mu * Fn, 0.0)
            if Ft > limit:
                more = min((Ft - limit) / (kt - laws[RT, n] / end_of_slip), Ft / kt)
                left = max(left - more / end_of_slip, 0.0)
                omega = exchanged(left, coupling)
                if omega < 1.0:
                    slip += more
                    Ft = kt * (ut * k / STRAIGHT - slip)
        if omega >= 1.0:
            limit = mu * max(-kn * (u - shortened), 0.0)
            if Ft > limit:
                slip, Ft = slip + (Ft - limit) / kt, limit
        work, before = work + 0.5 * (Ft + before) * ut / STRAIGHT, Ft
    return work


@compiled
def begin(memory, where, numbers, laws, hardening, dissipated, by_slip):
    """Add to sums (m,) J what bonds (k,) slipped that are found softened or slipped for the first time, as if each had
    come to its displacements on a straight path. -> J, of all."""
    total = 0.0
    for n in numbers:
        omega, shear = memory[where[OMEGA, n]], read(memory, where[SHEAR_FORCE, n])
        un = (opening(min(omega, 1.0), laws[OPEN_AT_PEAK, n], laws[OPEN_AT_END, n]) if omega > 0.0 else
              -dot(read(memory, where[NORMAL_FORCE, n]), read(memory, where[NORMAL, n])) / laws[KN, n])
        strain = read(memory, where[STRAIN, n])
        ut = math.sqrt(dot(strain, strain)) * memory[where[LENGTH, n]]
        # What the present force stores is not spent; where it is above the law's, it falls in the next step.
        work = slip_work(n, laws, hardening, un, ut) - 0.5 * dot(shear, shear) / laws[KT, n]
        dissipated[n] += work
        by_slip[n] += work
        total += work
    return total


@compiled
def look(memory, where, status, separated, laws, hardening, crushes, omega, active, slid, strains, lengths, dissipated,
         by_slip):
    """Which of the bonds softened or slipped since the last look, without those `separated` by their status (m,);
    harden those that crushed.

    omega: (m,), as of the last look, strains: (m,), YADE's plastic ones, and lengths: (m,) m, are brought up to date;
    active: (m,), whether they had slipped or softened by then; slid: (m,) m, slip since then that is out of their
    strains; crushes: whether bonds crush, hardening: their h. Works are added to the sums (m,) J. -> numbers (l,); of
    those whose damage rose and that hold on by a coupled cohesion; of those that YADE has broken; and J of crushing and
    of softening.
    """
    most = len(status)
    numbers, count, crushing, softening = np.empty(most, np.int64), 0, 0.0, 0.0
    rising, risen, gone, broken = np.empty(most, np.int64), 0, np.empty(most, np.int64), 0
    for n in range(most):
        if status[n] == separated:
            continue
        now = memory[where[OMEGA, n]]
        if (now != omega[n] or slid[n] > 0.0 or not vanishes(read(memory, where[SLIPPED, n]))
                or active[n] and vanishes(read(memory, where[SHEAR_FORCE, n]))):
            numbers[count] = n
            count += 1
            if now > omega[n]:
                softening += soften(n, omega[n], now, laws, dissipated)
                if now >= 1.0:
                    gone[broken] = n
                    broken += 1
                elif laws[COUPLING, n] > 0.0:
                    rising[risen] = n
                    risen += 1
            omega[n] = now
        if crushes and memory[where[CRUSHED, n]] != strains[n]:
            work = harden(memory, where, n, laws, hardening, strains, lengths)
            dissipated[n] += work
            by_slip[n] += work
            crushing += work
    return numbers[:count].copy(), rising[:risen].copy(), gone[:broken].copy(), crushing, softening


@compiled
def damage(memory, where, n, laws, slip, before):
    """Raise the damage `before` of bond n by its slip (m). In the next step its normal force falls to what the law then
    allows; what that dissipates is given now, and the force, which YADE only gives out, is that of then. (The slip of
    that step is sampled.) -> the damage now, J.
    """
    coupling = laws[COUPLING, n]
    left = max(exchanged(before, coupling) - slip / laws[SLIP_END, n], 0.0)
    omega = min(exchanged(left, coupling), SPENT)
    force = read(memory, where[NORMAL_FORCE, n])
    Fn = -dot(force, read(memory, where[NORMAL, n]))
    kept = (1.0 - omega) / (1.0 - before) if Fn > 0.0 else 1.0
    write(memory, where[NORMAL_FORCE, n], force[0] * kept, force[1] * kept, force[2] * kept)
    return omega, 0.5 * Fn**2 * (1.0 - kept) / (laws[KN, n] * (1.0 - before))


@compiled
def relieve(memory, where, numbers, late, laws, omega, slid, lengths, dissipated, by_slip):
    """Take the slip out of bonds (k,), damage them by it, and set their cohesion in YADE.

    late: (k,) bool, of which the work of that slip does not count yet: it is the slip times the limit that they bear
    now; omega: (m,), lengths: (m,) m; slid: (m,) m, slip that is out of their strains, 0 afterwards; works are added to
    sums (m,) J. -> numbers of those that slip has broken, J.
    """
    spent, count, total = np.empty_like(numbers), 0, 0.0
    for k, n in enumerate(numbers):
        slip = slid[n] + take_slip(memory, where, n, laws[KT, n] * lengths[n]) * lengths[n]
        slid[n] = 0.0
        if late[k]:
            work = slip * shear_limit(memory, where, n, laws)
            dissipated[n] += work
            by_slip[n] += work
            total += work
        if slip > 0.0 and omega[n] < SPENT and laws[SLIP_END, n] < math.inf:
            omega[n], work = damage(memory, where, n, laws, slip, omega[n])
            dissipated[n] += work
            total += work
            set_damage(memory, where, n, omega[n])
            if omega[n] == SPENT:
                spent[count] = n
                count += 1
        if laws[COUPLING, n] > 0.0:
            set_cohesion(memory, where, n, laws)
    return spent[:count].copy(), total


# ---- contacts with friction

CONTACT = ("geom", "phys", "bodies", "normal_force", "shear_force", "viscous_force", "friction", "kn", "ks", "cn",
           "normal", "increment", "point", "state", "velocity", "spin", "position", "blocked")
"""What a layout of contacts and bodies says, (18,), of each how far behind it lies: behind a contact, pointers to its
geometry and its constants and its two bodies; behind the constants, the forces (N), the friction, stiffness and damping
(N/m, N s/m); behind the geometry, the normal, the shear increment (m) of the step and the point of contact (m); behind
a body, the pointer to its state; behind the state, its motion (m/s, rad/s) and place (m), and the mask of its blocked
degrees of freedom."""
(GEOMETRY, CONSTANTS, BODIES, OF_NORMAL, OF_SHEAR, OF_DASHPOT, FRICTION, STIFFNESS, SHEAR_STIFFNESS, DAMPING, DIRECTION,
 MOVED, POINT, STATE, VELOCITY, SPIN, POSITION, BLOCKED) = range(18)
"""Where in a layout it does."""
FRICTION_WORK, TOOL_WORK, DASHPOT_WORK, IMPULSE = range(4)
"""Places of what `sample_tool` adds up, of the impulse the first."""
SUMMED, PERMANENT = 12, 18
"""Words from the lists of forces, or torques, that YADE's threads add to those of their sums, which the integrator
makes and takes, and of the permanent ones."""
SLIDING = 1 - 1e-9
"""|Ft| / mu |Fn| from which a contact slid in this step: YADE's laws return it to Coulomb's limit to round-off. (A
looser test counts contacts that oscillate near the limit as sliding, and their work adds up.)"""


@compiled
def norm(a):
    """Of a vector."""
    return math.sqrt(dot(a, a))


@compiled
def less(a, b):
    """Difference of two vectors."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@compiled
def cross(a, b):
    """Of two vectors."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@compiled
def pointed(pointer):
    """Index in memory of what a pointer points to."""
    return (pointer >> 3) - 1


@compiled
def is_real(words, layout, contact):
    """Whether this contact, at its place, is in contact now."""
    return words[contact + layout[GEOMETRY]] != 0 and words[contact + layout[CONSTANTS]] != 0


@compiled
def ends_of(words, layout, contact):
    """The two bodies of a contact."""
    both = words[contact + layout[BODIES]]
    return both & 0xffffffff, both >> 32


@compiled
def is_there(words, bodies, body):
    """Whether a body has not been erased. bodies: place of the pointer to the list of them."""
    return words[pointed(words[bodies]) + 2 * body] != 0


@compiled
def state_of(words, layout, bodies, body):
    """Place of the state of a body that is there."""
    return pointed(words[pointed(words[pointed(words[bodies]) + 2 * body]) + layout[STATE]])


@compiled
def states_of(words, layout, bodies, numbers):
    """(k,) places of the states of these bodies (k,), which are there."""
    found = np.empty(len(numbers), np.int64)
    for k, body in enumerate(numbers):
        found[k] = state_of(words, layout, bodies, body)
    return found


@compiled
def positions(memory, words, layout, bodies, count):
    """(count, 3) m of the bodies 0..count-1, nan of one that has been erased."""
    found = np.full((count, 3), np.nan)
    for body in range(count):
        if is_there(words, bodies, body):
            found[body] = read(memory, state_of(words, layout, bodies, body) + layout[POSITION])
    return found


@compiled
def between_ends(memory, words, layout, bodies, ends):
    """(k, 6) m, the middle of two bodies (k, 2), and the unit vector from the first to the second; nan where one has
    been erased. bodies: see `is_there`."""
    found = np.full((len(ends), 6), np.nan)
    for k, (first, second) in enumerate(ends):
        if is_there(words, bodies, first) and is_there(words, bodies, second):
            start = read(memory, state_of(words, layout, bodies, first) + layout[POSITION])
            end = read(memory, state_of(words, layout, bodies, second) + layout[POSITION])
            way = less(end, start)
            length = norm(way)
            for along in range(3):
                found[k, along], found[k, 3 + along] = 0.5 * (start[along] + end[along]), way[along] / length
    return found


@compiled
def add(a, b, factor):
    """a + b times a factor, of vectors."""
    return a[0] + b[0] * factor, a[1] + b[1] * factor, a[2] + b[2] * factor


@compiled
def exerted(memory, words, lists, body):
    """(3,) N or N m on a body in this step so far. lists: place of a pointer to the lists of what each thread of YADE's
    adds, by body; PERMANENT behind it, of a pointer to the list of what is permanent."""
    one, end = pointed(words[lists]), pointed(words[lists + 1])
    x, y, z = 0.0, 0.0, 0.0
    while one < end:
        begin = pointed(words[one])
        if begin + 3 * body < pointed(words[one + 1]):
            x, y, z = add((x, y, z), read(memory, begin + 3 * body), 1.0)
        one += 3
    begin = pointed(words[lists + PERMANENT])
    if begin + 3 * body < pointed(words[lists + PERMANENT + 1]):
        x, y, z = add((x, y, z), read(memory, begin + 3 * body), 1.0)
    return x, y, z


@compiled
def taken(memory, words, lists, body):
    """(3,) N or N m on a body that the integrator took in the step that has just been made. lists: see `exerted`."""
    one, end = pointed(words[lists + SUMMED]) + 3 * body, pointed(words[lists + SUMMED + 1])
    if one >= end:
        # Nothing was ever exerted on a body as far back in the list.
        return 0.0, 0.0, 0.0
    return read(memory, one)


@compiled
def acting(memory, words, lists, body, since):
    """(3,) N or N m on a body in this step. lists: see `exerted`; since: see `velocity_at`."""
    if since > 0.0:
        return taken(memory, words, lists, body)
    return exerted(memory, words, lists, body)


@compiled
def exerted_on(memory, words, lists, numbers):
    """(k, 3) `exerted` on these bodies (k,)."""
    found = np.empty((len(numbers), 3))
    for k, body in enumerate(numbers):
        found[k, 0], found[k, 1], found[k, 2] = exerted(memory, words, lists, body)
    return found


@compiled
def free(vector, blocked):
    """A vector whose components are 0 where a bit of the mask is set, of the first the lowest bit."""
    x, y, z = vector
    return 0.0 if blocked & 1 else x, 0.0 if blocked & 2 else y, 0.0 if blocked & 4 else z


@compiled
def accelerations(memory, words, layout, bodies, motion, since, body):
    """m/s2 and rad/s2 of a body 0..n-1 by what acts on it in this step, 0 where it is held. motion, since: see
    `velocity_at`."""
    forces, torques, per_mass, per_inertia, _, gravity = motion
    if not per_mass[body] > 0.0:
        return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    faster = add((gravity[0], gravity[1], gravity[2]), acting(memory, words, forces, body, since), per_mass[body])
    turning = add((0.0, 0.0, 0.0), acting(memory, words, torques, body, since), per_inertia[body])
    blocked = words[state_of(words, layout, bodies, body) + layout[BLOCKED]]
    return free(faster, blocked), free(turning, blocked >> 3)


@compiled
def velocity_at(memory, words, layout, bodies, motion, since, body, point):
    """m/s, before the integrator, of a point (m) of a rigid body that is there.

    motion: places of the pointers to the lists of forces and of torques (see `exerted`), (n,) 1/kg, (n,) 1/(kg m2) and
    (n,) m of the bodies 0..n-1, and (3,) m/s2 of gravity; since: 0 before the integrator, the time step (s) after it,
    when bodies have moved on and 0..n-1 are faster by what their forces did.
    """
    state = state_of(words, layout, bodies, body)
    velocity, spin = read(memory, state + layout[VELOCITY]), read(memory, state + layout[SPIN])
    place = add(read(memory, state + layout[POSITION]), velocity, -since)
    if since > 0.0 and body < len(motion[2]):
        faster, turning = accelerations(memory, words, layout, bodies, motion, since, body)
        velocity, spin = add(velocity, faster, -since), add(spin, turning, -since)
    return add(velocity, cross(spin, less(point, place)), 1.0)


@compiled
def velocities(memory, words, layout, bodies, motion, since, contact):
    """m/s of the first and of the second body at the point of contact, before the integrator; see `velocity_at`."""
    first, second = ends_of(words, layout, contact)
    point = read(memory, pointed(words[contact + layout[GEOMETRY]]) + layout[POINT])
    return (velocity_at(memory, words, layout, bodies, motion, since, first, point),
            velocity_at(memory, words, layout, bodies, motion, since, second, point))


@compiled
def tool_slip(memory, words, layout, bodies, motion, since, contact, before, dt):
    """Irreversible slip (m) in this step of a contact that slides. before: (3,) N, its shear force before the step;
    motion, since: see `velocity_at`.

    That is what its spring does not take up, (|trial force| - |Ft|) / ks, less the excess of YADE's slip over that of
    the surfaces at the contact point, over which forces work: YADE rotates spheres about their full radii and scales
    translations to match (kernels.stability).
    """
    phys = pointed(words[contact + layout[CONSTANTS]])
    geom = pointed(words[contact + layout[GEOMETRY]])
    ks, force = memory[phys + layout[SHEAR_STIFFNESS]], read(memory, phys + layout[OF_SHEAR])
    increment, normal = read(memory, geom + layout[MOVED]), read(memory, geom + layout[DIRECTION])
    x, y, z = -ks * increment[0], -ks * increment[1], -ks * increment[2]
    stored = before[0], before[1], before[2]
    size = norm(stored)
    if size > 0.0:
        # YADE rotates the spring with the contact.
        along = dot(stored, normal)
        rotated = less(stored, (normal[0] * along, normal[1] * along, normal[2] * along))
        scale = size / norm(rotated)
        x, y, z = x + rotated[0] * scale, y + rotated[1] * scale, z + rotated[2] * scale
    after, length = norm(force), norm(increment)
    slip = max(norm((x, y, z)) - after, 0.0) / ks
    if not (slip > 0.0 and after * length > 0.0):
        return slip
    first, second = velocities(memory, words, layout, bodies, motion, since, contact)
    way = less(second, first)
    excess = dot(force, less((way[0] * dt, way[1] * dt, way[2] * dt), increment)) / after
    # Part of the step's displacement may have gone into the spring.
    return slip - excess * min(slip / length, 1.0)


@compiled
def sample_tool(memory, words, layout, bodies, motion, since, contacts, least, parts, needs, before, elapsed, dt,
                sampled, stored, seconds, tool_work, rock_work, slid, totals):
    """What contacts of the tool (k,) that are in contact now, and as stiff as `least` (N/m), do in this step.

    motion, of the rock, since: see `velocity_at`; contacts: places; parts: (3, k) piece of the tool, rock particle, and
    1 where the tool's body is the first, else 0; needs: (2, e) sums that wear needs, 1 for the force that presses or 0
    for friction, and its exponent; before: (k, 4) shear force (N) before the step, and 1 where there was contact; dt:
    s.

    Where `sampled`, these are added to for `elapsed` (s), for which this step stands: seconds (k,) in contact;
    tool_work (m,), rock_work (n,) J of friction; slid (e, m), force^exponent times slip; totals (6,): friction, work of
    the tool, of dashpots (J), and impulse on the tool (N s). Where `stored`, `before` is that of the next step. -> J of
    friction as YADE counts it, slip times the force after it.

    Friction is the slip times the mean of the forces before and
    after the step, so that the work of the leapfrog integrator and the energy of the springs balance exactly. The
    tool's work is F v dt with the velocity of the tool at the contact point.
    """
    in_yade = 0.0
    for k, contact in enumerate(contacts):
        if not is_real(words, layout, contact):
            if stored:
                before[k] = 0.0
            continue
        phys = pointed(words[contact + layout[CONSTANTS]])
        shear = read(memory, phys + layout[OF_SHEAR])
        if sampled and memory[phys + layout[STIFFNESS]] >= least:
            piece, rock, tool_first = parts[0, k], parts[1, k], parts[2, k] == 1
            normal = read(memory, phys + layout[OF_NORMAL])
            seconds[k] += elapsed
            # YADE puts N + S on the second body and its opposite on the first.
            sign = -elapsed if tool_first else elapsed
            push = (normal[0] + shear[0]) * sign, (normal[1] + shear[1]) * sign, (normal[2] + shear[2]) * sign
            for along in range(3):
                totals[IMPULSE + along] += push[along]
            of_first, of_second = velocities(memory, words, layout, bodies, motion, since, contact)
            totals[TOOL_WORK] -= dot(push, of_first if tool_first else of_second)
            cn = memory[phys + layout[DAMPING]]
            if cn > 0.0:
                dashpot = read(memory, phys + layout[OF_DASHPOT])
                faster, _ = accelerations(memory, words, layout, bodies, motion, since, rock)
                gain = dot(dashpot, faster) * (0.5 * dt if tool_first else -0.5 * dt)
                totals[DASHPOT_WORK] += (dot(dashpot, dashpot) / cn + gain) * elapsed
            after = norm(shear)
            if after > 0.0 and after >= SLIDING * memory[phys + layout[FRICTION]] * norm(normal):
                slip = tool_slip(memory, words, layout, bodies, motion, since, contact, before[k], dt) * elapsed / dt
                mean = 0.5 * (norm((before[k, 0], before[k, 1], before[k, 2])) + after)
                work = mean * slip
                totals[FRICTION_WORK] += work
                in_yade += slip * after
                tool_work[piece] += work
                rock_work[rock] += work
                # A dashpot may pull; only compression presses the surfaces together.
                geom = pointed(words[contact + layout[GEOMETRY]])
                pressing = max(dot(normal, read(memory, geom + layout[DIRECTION])), 0.0)
                for need in range(needs.shape[1]):
                    slid[need, piece] += (pressing if needs[0, need] == 1.0 else mean)**needs[1, need] * slip
        if stored:
            before[k, 0], before[k, 1], before[k, 2], before[k, 3] = shear[0], shear[1], shear[2], 1.0
    return in_yade


@compiled
def between_rock(words, layout, contacts, particles, others):
    """Of all contacts those between bodies 0..particles-1 whose constants are of none of the classes `others`: (l, 3)
    places and bodies. contacts: place of the pointer to the list of them."""
    found, count = np.empty((64, 3), np.int64), 0
    one, end = pointed(words[contacts]), pointed(words[contacts + 1])
    while one < end:
        contact = pointed(words[one])
        one += 2
        first, second = ends_of(words, layout, contact)
        if max(first, second) >= particles:
            continue
        phys, other = words[contact + layout[CONSTANTS]], False
        if phys != 0:
            kind = words[pointed(phys)]
            for k in range(len(others)):
                other = other or kind == others[k]
        if not other:
            if count == len(found):
                found = np.concatenate((found, np.empty_like(found)))
            found[count, 0], found[count, 1], found[count, 2] = contact, first, second
            count += 1
    return found[:count].copy()


@compiled
def by_bodies(found, particles):
    """Contacts (k, 3), places and bodies below `particles`, in the order of their bodies: a loaded scene has them in
    another order."""
    return found[np.argsort(found[:, 1] * particles + found[:, 2])]


@compiled
def touches(words, layout, bodies, contact, first, second):
    """Whether two bodies are in contact now. contact: its place, no longer that of a contact where one was erased."""
    return is_there(words, bodies, first) and is_there(words, bodies, second) and is_real(words, layout, contact)


@compiled
def touching(words, layout, bodies, contacts):
    """(l, 2) bodies of those of the contacts (k, 3), places and bodies, that are in contact now."""
    found, count = np.empty((len(contacts), 2), np.int64), 0
    for contact, first, second in contacts:
        if touches(words, layout, bodies, contact, first, second):
            found[count, 0], found[count, 1] = first, second
            count += 1
    return found[:count].copy()


@compiled
def rub(memory, words, layout, bodies, motion, since, contacts, friction, elapsed, dt, work):
    """Add the friction work (J) of those contacts (k, 3) of particles that slide in this step to `work` (n,). -> J, of
    all.

    motion, since: see `velocity_at`; contacts: places and bodies; friction: (k,), nan where YADE has it; elapsed: s,
    for which this step stands, of dt (s). The work is |Ft| times the irreversible slip [Rojek 2014, eq. 36], which is
    the slip less what a rising limit mu |Fn| lets the spring take up. The velocity is the mean of those before and
    after the step.
    """
    radii, total = motion[4], 0.0
    for k in range(len(contacts)):
        contact, first, second = contacts[k]
        if not touches(words, layout, bodies, contact, first, second):
            continue
        phys = pointed(words[contact + layout[CONSTANTS]])
        mu, shear = friction[k], read(memory, phys + layout[OF_SHEAR])
        if math.isnan(mu):
            mu = memory[phys + layout[FRICTION]]
        limit, tangential = mu * norm(read(memory, phys + layout[OF_NORMAL])), norm(shear)
        if not tangential > SLIDING * limit > 0.0:
            continue
        normal = read(memory, pointed(words[contact + layout[GEOMETRY]]) + layout[DIRECTION])
        of_first, of_second = velocities(memory, words, layout, bodies, motion, since, contact)
        faster_first, turning_first = accelerations(memory, words, layout, bodies, motion, since, first)
        faster_second, turning_second = accelerations(memory, words, layout, bodies, motion, since, second)
        turn = add(add((0.0, 0.0, 0.0), turning_first, radii[first]), turning_second, radii[second])
        faster = less(less(faster_second, faster_first), cross(turn, normal))
        velocity = add(less(of_second, of_first), faster, 0.5 * dt)
        slip = -dot(shear, velocity) / tangential
        taken_up = -mu * memory[phys + layout[STIFFNESS]] / memory[phys + layout[SHEAR_STIFFNESS]] * dot(
            normal, velocity)
        done = tangential * max(slip - taken_up, 0.0) * elapsed
        total += done
        work[first] += 0.5 * done
        work[second] += 0.5 * done
    return total


# ---- supports of an absorbing boundary

@compiled
def along_and_across(x, y, normal):
    """Components of a vector along a normal (2,) and across it."""
    return x * normal[0] + y * normal[1], y * normal[0] - x * normal[1]


@compiled
def split(vectors, normals):
    """(k,) components of vectors (k, 2) along the normals (k, 2) and across them."""
    along, across = np.empty(len(vectors)), np.empty(len(vectors))
    for k in range(len(vectors)):
        along[k], across[k] = along_and_across(vectors[k, 0], vectors[k, 1], normals[k])
    return along, across


@compiled
def dashpot_power(memory, moving, normals, cn, ct):
    """W that dashpots (k,) take now. moving: (2, k) places of the velocities of their particles; cn, ct: N s/m."""
    power = 0.0
    for k in range(len(cn)):
        along, across = along_and_across(memory[moving[0, k]], memory[moving[1, k]], normals[k])
        power += cn[k] * along**2 + ct[k] * across**2
    return power


@compiled
def gone_far(memory, in_plane, places, normals, limits):
    """Whether a particle (k,) has moved by more than its limit (m) from its place (k, 2) m, along its normal.
    in_plane: (2, k) places of their positions in memory."""
    for k in range(len(limits)):
        x, y = memory[in_plane[0, k]] - places[k, 0], memory[in_plane[1, k]] - places[k, 1]
        if abs(along_and_across(x, y, normals[k])[0]) > limits[k]:
            return True
    return False

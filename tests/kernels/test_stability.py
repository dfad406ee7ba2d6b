"""The critical time step: exact values, rigid motions, a time integration on either side of it."""
import math

import numpy as np
import pytest

from rockwear.kernels import stability
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.packing import contacts, pack
from rockwear.kernels.stability import critical_time_step


def equal_discs(positions, bonds, kn=2e10, kt=0.0, radius=0.5, mass=3.0, inertia=0.375, **options):
    n = len(positions)
    return critical_time_step(positions=positions, radii=np.full(n, radius), masses=np.full(n, mass),
                              inertias=np.full(n, inertia), bonds=bonds, kn=kn, kt=kt, **options)


def specimen(dimensions, seed=1):
    box = (0.03, 0.025) if dimensions == 2 else (0.012, 0.012, 0.014)
    p = pack(box=box, radius_min=1e-3, radius_max=1.5e-3, porosity=0.12 if dimensions == 2 else 0.36, seed=seed)
    mass = 2841 * (np.pi * p.radii**2 if dimensions == 2 else 4 / 3 * np.pi * p.radii**3)
    return {"positions": p.positions, "radii": p.radii, "masses": mass,
            "inertias": (0.5 if dimensions == 2 else 0.4) * mass * p.radii**2,
            "bonds": contacts(p.positions, p.radii, 1e-4)}


def energy_stiffness(positions, radii, bonds, kn, kt):
    """K as the Hessian of the bonds' energy: an independent way, each bond by the relative motion at its contact."""
    x = np.asarray(positions, dtype=float)
    n, d = x.shape
    angular_velocity = 1 if d == 2 else 3
    stiffness = np.zeros((n * (d + angular_velocity),) * 2)
    for i, j in bonds:
        normal = (x[j] - x[i]) / np.linalg.norm(x[j] - x[i])
        half = 0.5 * (radii[i] + radii[j] - np.linalg.norm(x[j] - x[i]))
        point = x[i] + (radii[i] - half) * normal
        motion = []  # velocity of j's material at the contact against that of i's
        for body, sign in ((i, -1.0), (j, 1.0)):
            arm = point - x[body]
            turn = np.array([[-arm[1]], [arm[0]]]) if d == 2 else np.cross(np.eye(3), arm).T
            motion.append(sign * np.hstack([np.eye(d), turn]))
        motion = np.hstack(motion)
        projector = np.outer(normal, normal)
        dofs = np.add.outer(np.array([i, j]) * (d + angular_velocity), np.arange(d + angular_velocity)).ravel()
        stiffness[np.ix_(dofs, dofs)] += motion.T @ (kn * projector + kt * (np.eye(d) - projector)) @ motion
    return stiffness


def lumped(masses, inertias, d):
    return np.hstack([np.tile(masses[:, None], d), np.tile(inertias[:, None], 1 if d == 2 else 3)]).ravel()


def test_two_discs_one_bond():
    """Normal: Ω² = 2 kn/m. Shear of touching discs, I = ½ m r²: Ω² = 2 kt/m + 2 kt r²/I = 6 kt/m."""
    x = [[0, 0], [0.6, 0.8]]
    assert equal_discs(x, [[0, 1]]) == pytest.approx(2 / math.sqrt(2 * 2e10 / 3), rel=1e-5)
    assert equal_discs(x, [[0, 1]], kt=2e10) == pytest.approx(2 / math.sqrt(6 * 2e10 / 3), rel=1e-5)


@pytest.mark.parametrize("distance", [0.9, 1.0, 1.2])
def test_arms_reach_to_the_middle_of_overlap_or_gap(distance):
    """Discs alike: arm a = ½ distance, whatever the radius."""
    expected = 2 / math.sqrt(2 * 2e10 / 3 + 2 * 2e10 * (distance / 2) ** 2 / 0.375)
    assert equal_discs([[0, 0], [distance, 0]], [[0, 1]], kt=2e10) == pytest.approx(expected, rel=1e-5)


def test_two_spheres_one_bond():
    """I = 2/5 m r²: Ω² = 2 kt/m + 2 kt r²/I = 7 kt/m."""
    x = np.array([[0, 0, 0], [2, 3, 6]]) / 7
    assert equal_discs(x, [[0, 1]], inertia=0.3) == pytest.approx(2 / math.sqrt(2 * 2e10 / 3), rel=1e-5)
    assert equal_discs(x, [[0, 1]], kt=2e10, inertia=0.3) == pytest.approx(2 / math.sqrt(7 * 2e10 / 3), rel=1e-5)


@pytest.mark.parametrize("n", [5, 400])
def test_chain(n):
    """Free chain of n masses: Ω² = 2 k/m (1 + cos(π/n)). 400 masses take the sparse way."""
    x = np.column_stack([np.arange(n), np.zeros(n)])
    bonds = np.column_stack([np.arange(n - 1), np.arange(1, n)])
    exact = 2 / math.sqrt(2 * 2e10 / 3 * (1 + math.cos(math.pi / n)))
    assert equal_discs(x, bonds) == pytest.approx(exact, rel=1e-5)
    assert equal_discs(x, bonds) <= exact


def test_triangular_lattice():
    """kt = 0: the dispersion relation ends at Ω² = 6 kn/m; a large patch approaches it from below."""
    a, b = np.meshgrid(np.arange(40), np.arange(40))
    x = np.column_stack([(a + 0.5 * (b % 2)).ravel(), (math.sqrt(0.75) * b).ravel()])
    bonds = contacts(x, np.full(len(x), 0.5), 1e-9)
    limit = 2 / math.sqrt(6 * 2e10 / 3)
    assert limit < equal_discs(x, bonds) < 1.004 * limit


def test_square_lattice_with_rotation():
    """kt = kn = k, wave vector (π, π)/D: Ω² = 4 k/m + 4 k/m for u. Rotations alike, at zero wave vector: 8 k r²/I."""
    a, b = np.meshgrid(np.arange(30), np.arange(30))
    x = np.column_stack([a.ravel(), b.ravel()]).astype(float)
    bonds = contacts(x, np.full(len(x), 0.5), 1e-9)
    assert 1 < equal_discs(x, bonds, kt=2e10) / (2 / math.sqrt(16 * 2e10 / 3)) < 1.01


@pytest.mark.parametrize("dimensions", [2, 3])
def test_against_the_hessian(dimensions):
    s = specimen(dimensions)
    kn, kt = 2e10, 6e9
    k = energy_stiffness(s["positions"], s["radii"], s["bonds"], kn, kt)
    shank = 1 / np.sqrt(lumped(s["masses"], s["inertias"], dimensions))
    values = np.linalg.eigvalsh(k * shank * shank[:, None])
    exact = 2 / math.sqrt(values[-1])
    assert critical_time_step(**s, kn=kn, kt=kt) == pytest.approx(exact, rel=2e-6)
    assert critical_time_step(**s, kn=kn, kt=kt) <= exact


@pytest.mark.parametrize("dimensions", [2, 3])
def test_rigid_motions_cost_nothing(dimensions):
    s = specimen(dimensions)
    i, j = s["bonds"].T
    x, r = s["positions"], s["radii"]
    distance = np.linalg.norm(x[j] - x[i], axis=1)
    half = 0.5 * (r[i] + r[j] - distance)
    ones = np.ones(len(i))
    rows = stability.contact_rows(len(x), i, j, (x[j] - x[i]) / distance[:, None], r[i] - half, r[j] - half, ones, ones)
    spins = [np.array([0, 0, 1.0])] if dimensions == 2 else np.eye(3)
    for w in spins:
        x3 = np.pad(x, ((0, 0), (0, 3 - dimensions)))
        turn = np.hstack([np.cross(w, x3)[:, :dimensions], np.tile(w[2:] if dimensions == 2 else w, (len(x), 1))])
        assert np.abs(rows @ turn.ravel()).max() < 1e-12 * np.abs(x).max() * 10
        assert np.abs(rows @ np.roll(turn, 1, axis=0).ravel()).max() > 1e-4
    shift = np.zeros((len(x), len(turn[0])))
    shift[:, :dimensions] = 1.0
    assert np.abs(rows @ shift.ravel()).max() < 1e-12


def test_lanczos_agrees_with_all_eigenvalues(monkeypatch):
    s = specimen(2)
    sparse_way = critical_time_step(**s, kn=2e10, kt=2e10)
    monkeypatch.setattr(stability, "DENSE", 100_000)
    assert sparse_way == pytest.approx(critical_time_step(**s, kn=2e10, kt=2e10), rel=2e-6)


def test_reference_of_the_specimen():
    """109 mm specimen, 20e9 N/m: near 3.3e-7 s for kt = kn, 6.07e-7 s for kt = kn/5, in the mean of five packings."""
    steps = []
    for seed in range(1, 6):
        p = pack(box=(0.109, 0.109), radius_min=1e-3, radius_max=1.5e-3, porosity=0.12, seed=seed)
        mass = 2500 / 0.88 * np.pi * p.radii**2
        s = {"positions": p.positions, "radii": p.radii, "masses": mass, "inertias": 0.5 * mass * p.radii**2,
             "bonds": contacts(p.positions, p.radii)}
        steps.append([critical_time_step(**s, kn=20e9, kt=kt) for kt in (20e9, 4e9)])
    equal, fifth = np.mean(steps, axis=0)
    assert equal == pytest.approx(3.32e-7, rel=0.025) and fifth == pytest.approx(6.07e-7, rel=0.02)


def test_time_integration_on_either_side():
    """Leapfrog of M ü = −K u, undamped, from random velocities."""
    s = specimen(2)
    kn = kt = 2e10
    k = energy_stiffness(s["positions"], s["radii"], s["bonds"], kn, kt)
    mass = lumped(s["masses"], s["inertias"], 2)
    step = critical_time_step(**s, kn=kn, kt=kt)
    flexible = k / mass[:, None]

    def energy_after(factor):
        v = np.random.default_rng(0).standard_normal(len(mass)) / np.sqrt(mass)
        u, dt = np.zeros(len(mass)), factor * step
        start = v @ (mass * v)
        for _ in range(600):
            v -= dt * (flexible @ u)
            u += dt * v
        return v @ (mass * v) / start

    assert energy_after(0.99) < 20
    assert energy_after(1.01) > 1e6


def test_fixed_particles_do_not_move():
    """A disc between two fixed ones: Ω² = 2 kn/m; nothing left to move, no limit."""
    x = [[0, 0], [1, 0], [2, 0]]
    assert equal_discs(x, [[0, 1], [1, 2]], fixed=[0, 2]) == pytest.approx(2 / math.sqrt(2 * 2e10 / 3), rel=1e-5)
    assert equal_discs(x, [[0, 1], [1, 2]], fixed=(0, 1, 2)) == math.inf
    assert equal_discs(x, []) == math.inf


def test_stiffness_for_each_bond():
    x = [[0, 0], [1, 0], [5, 0], [6, 0]]
    dt = equal_discs(x, [[0, 1], [2, 3]], kn=[1e10, 4e10], kt=[0, 0])
    assert dt == pytest.approx(2 / math.sqrt(2 * 4e10 / 3), rel=1e-5)


def test_damping_shortens_the_step():
    """[Rojek 2003, eq. 3.37]."""
    x = [[0, 0], [1, 0]]
    ratio = equal_discs(x, [[0, 1]], damping_ratio=0.3) / equal_discs(x, [[0, 1]])
    assert ratio == pytest.approx(math.sqrt(1.09) - 0.3)


def test_ground_is_a_bond_to_a_fixed_particle():
    x, direction = [[0, 0], [1, 0]], np.array([0.6, 0.8])
    grounded = equal_discs(x, [[0, 1]], kt=4e9, ground=([1], [2 * direction], 9e10, 3e10))
    bonded = equal_discs([*x, x[1] + direction], [[0, 1], [1, 2]], kn=[2e10, 9e10], kt=[4e9, 3e10], fixed=[2])
    assert grounded == pytest.approx(bonded, rel=1e-9)
    alone = equal_discs([[0, 0]], [], ground=([0], [[0, -1]], 9e10, 0.0))
    assert alone == pytest.approx(2 / math.sqrt(9e10 / 3), rel=1e-5)


def damped(dashpot, **changes):
    """Two discs alike with a normal spring, and a dashpot as a fraction of the critical one of their mode."""
    return equal_discs([[0, 0], [1, 0]], [[0, 1]], cn=dashpot * 2 * math.sqrt(2e10 * 1.5), **changes)


@pytest.mark.parametrize("ratio", [0.1, 0.9, 3.0])
def test_a_dashpot_on_one_mode(ratio):
    """[Rojek 2003, eq. 3.37] is exact there, and equal to a spring of 2 cn/Δt."""
    expected = (math.sqrt(1 + ratio**2) - ratio) * damped(0.0)
    assert damped(ratio) == pytest.approx(expected, rel=3e-6) and damped(ratio) <= expected
    cn = ratio * 2 * math.sqrt(2e10 * 1.5)
    assert equal_discs([[0, 0], [1, 0]], [[0, 1]], kn=2e10 + 2 * cn / expected) == pytest.approx(expected, rel=3e-6)


def test_a_dashpot_alone():
    """M v⁺ = M v⁻ − Δt C v⁻ of two discs: stable up to Δt = m/cn."""
    assert equal_discs([[0, 0], [1, 0]], [[0, 1]], kn=0.0, cn=1e5) == pytest.approx(3.0 / 1e5, rel=3e-6)
    assert equal_discs([[0, 0], [1, 0]], [[0, 1]], kn=0.0, cn=1e5, fixed=[0, 1]) == math.inf


def test_a_dashpot_of_the_ground_is_that_of_a_fixed_particle():
    x, direction = [[0, 0], [1, 0]], np.array([0.6, 0.8])
    grounded = equal_discs(x, [[0, 1]], kt=4e9, ground=([1], [direction], 9e10, 3e10, 6e5))
    bonded = equal_discs([*x, x[1] + direction], [[0, 1], [1, 2]], kn=[2e10, 9e10], kt=[4e9, 3e10], fixed=[2],
                         cn=[0, 6e5])
    assert grounded == pytest.approx(bonded, rel=1e-9)
    assert grounded < 0.9 * equal_discs(x, [[0, 1]], kt=4e9, ground=([1], [direction], 9e10, 3e10))


def test_a_spring_and_a_dashpot_at_right_angles_and_askew():
    """One disc: at right angles each has its own limit; askew, Δt² K + 2 Δt C of two degrees of freedom has it."""
    m, kn, cn = 3.0, 2e10, 2e5
    for angle in (0.5 * math.pi, 0.3 * math.pi):
        n = np.array([math.cos(angle), math.sin(angle)])
        step = critical_time_step(positions=[[0, 0], [1, 0], n], radii=[0.5] * 3, masses=[m] * 3, inertias=[0.375] * 3,
                                  bonds=[[0, 1], [0, 2]], kn=[kn, 0.0], kt=0.0, cn=[0.0, cn], fixed=[1, 2])
        both = step**2 * kn * np.diag([1.0, 0.0]) + 2 * step * cn * np.outer(n, n)
        assert np.linalg.eigvalsh(both).max() == pytest.approx(4 * m, rel=5e-6)
    assert step < 0.9 * min(2 / math.sqrt(kn / m), 2 * m / cn)


def spectral_radius(s, step, kn, kt, cn):
    """Of one step v⁺ = v − Δt M⁻¹(K x + C v), x⁺ = x + Δt v⁺, all its eigenvalues: another way than the kernel's."""
    mass = lumped(s["masses"], s["inertias"], 2)
    k = energy_stiffness(s["positions"], s["radii"], s["bonds"], kn, kt) / mass[:, None]
    c = sum(energy_stiffness(s["positions"], s["radii"], [bond], cn_one, 0.0) / mass[:, None]
            for bond, cn_one in zip(s["bonds"], cn) if cn_one)
    one = np.eye(len(mass))
    velocity = np.hstack([-step * k, one - step * c])
    return abs(np.linalg.eigvals(np.vstack([np.hstack([one, 0 * one]) + step * velocity, velocity]))).max()


@pytest.mark.parametrize("dense", [False, True])
def test_contacts_with_and_without_dashpots(monkeypatch, dense):
    """The largest multiplier of a step passes 1 at the critical one, dashpots of any size on a tenth of the bonds."""
    if dense:
        monkeypatch.setattr(stability, "DENSE", 100_000)
    s, rng = specimen(2), np.random.default_rng(4)
    cn = np.where(rng.uniform(size=len(s["bonds"])) < 0.1, rng.uniform(0, 3e6, len(s["bonds"])), 0.0)
    step = critical_time_step(**s, kn=2e10, kt=4e9, cn=cn)
    assert step < 0.8 * critical_time_step(**s, kn=2e10, kt=4e9)
    assert spectral_radius(s, step, 2e10, 4e9, cn) < 1 + 1e-7
    assert spectral_radius(s, (1 + 1e-4) * step, 2e10, 4e9, cn) > 1 + 1e-5


@pytest.mark.parametrize("dimensions", [2, 3])
def test_free_of_ratcheting(dimensions):
    """K from YADE's shear increment on one side and its forces on the other, unequal particles that overlap."""
    s = specimen(dimensions)
    s["radii"] = 1.05 * s["radii"]
    x, r, kn, kt = s["positions"], s["radii"], 2e10, 2e10
    i, j = s["bonds"].T
    distance = np.linalg.norm(x[j] - x[i], axis=1)
    alpha, half, ones = (r[i] + r[j]) / distance, 0.5 * (r[i] + r[j] - distance), np.ones(len(i))
    normal = (x[j] - x[i]) / distance[:, None]
    seen = stability.contact_rows(len(x), i, j, normal, r[i] / alpha, r[j] / alpha, kn * ones, kt * alpha)
    pushed = stability.contact_rows(len(x), i, j, normal, r[i] - half, r[j] - half, kn * ones, kt * alpha)
    stiffness = (pushed.T @ seen).toarray() / lumped(s["masses"], s["inertias"], dimensions)[:, None]
    exact = 2 / math.sqrt(np.linalg.eigvals(stiffness).real.max())
    found = critical_time_step(**s, kn=kn, kt=kt, ratcheting_free=True)
    assert found == pytest.approx(exact, rel=1e-4)
    assert found < 0.98 * critical_time_step(**s, kn=kn, kt=kt)


@pytest.mark.parametrize("change, name", [
    ({"positions": [0.0, 1.0]}, "positions"), ({"positions": [[0, 0], [math.nan, 0]]}, "positions"),
    ({"radii": [1.0]}, "radii"), ({"radii": [1, 0]}, "radii"), ({"masses": [1, -1]}, "masses"),
    ({"masses": [1, math.inf]}, "masses"), ({"inertias": [0, 1]}, "inertias"), ({"bonds": [[0, 2]]}, "bonds"),
    ({"bonds": [[0, -1]]}, "bonds"), ({"bonds": [0, 1]}, "bonds"), ({"bonds": [[0.0, 1.0]]}, "bonds"),
    ({"bonds": [[1, 1]]}, "bonds"), ({"kn": -1.0}, "kn"), ({"kn": [1.0, 2.0]}, "kn"), ({"kt": math.nan}, "kt"),
    ({"fixed": [2]}, "fixed"), ({"damping_ratio": -0.1}, "damping_ratio"),
    ({"cn": -1.0}, "cn"), ({"cn": [0.0, 0.0]}, "cn"), ({"ground": ([0], [[0, 1]], 1.0, 0.0, -1.0)}, "ground"),
    ({"ground": ([0], [[0, 0]], 1.0, 0.0)}, "ground"), ({"ground": ([5], [[0, 1]], 1.0, 0.0)}, "ground"),
    ({"ground": ([0], [[0, 1, 0]], 1.0, 0.0)}, "ground"), ({"ground": ([0], [[0, 1]], -1.0, 0.0)}, "ground"),
])
def test_errors_name_the_parameter(change, name):
    good = {"positions": [[0, 0], [1, 0]], "radii": [0.5, 0.5], "masses": [1, 1], "inertias": [1, 1],
            "bonds": [[0, 1]], "kn": 1.0, "kt": 1.0}
    with pytest.raises(ParameterError) as error:
        critical_time_step(**{**good, **change})
    assert error.value.name == name and "\n" not in str(error.value)

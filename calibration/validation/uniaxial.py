"""Sections of make validate about the virtual laboratory: three bond laws, a published sandstone, loading speed."""
from statistics import mean

from calibration.campaigns import rock_laws
from calibration.campaigns import uniaxial_figures as figures
from calibration.campaigns.uniaxial import MAIN, ROCKS, SANDSTONE, SCRIPT, SMALL, SOFTENING, TESTS, folder_of
from calibration.validation.verdicts import Row, Section
from rockwear.report import published

SEEDS = 1, 2, 3
SOFT = {case: {**MAIN, **SOFTENING}[case] for case in ("damage 2e11", "damage 5e9", "damage 2e9", "plastic 2e10",
                                                       "plastic 2e9")}
SLOW = 0.025
FAST_ENOUGH = 0.02
"""Allowed relative error of strength and E at the default speed."""


def uniaxial(**values):
    """A run without a report."""
    return SCRIPT, dict(values, report="false", snapshot_period=1)


def balances(name, run):
    """Rows required of every laboratory run."""
    balance = run.summary["balances"]["energy"]
    return [Row(f"{name}: the specimen failed", 1, run.result("failed"), 0),
            Row(f"{name}: energy accounted for, of the platens' work", 1.0,
                1 - balance["residual"] / balance["platen_work"], 0.02)]


def laws(runs):
    """The three laws of [Rojek 2003, 5.1] side by side, and the effect of H."""
    main = {(case, test): runs[folder_of(case, test, 1)] for case in MAIN for test in TESTS}
    rows = [row for (case, test), run in main.items() for row in balances(f"{case}, {test}", run)]
    strength = {key: run.result("peak_stress") for key, run in main.items()}
    modulus = {key: run.result("youngs_modulus") for key, run in main.items()}
    for case in MAIN:
        rows.append(Row(f"{case}: E in tension over E in compression", 1.0,
                        modulus[case, "tension"] / modulus[case, "compression"], 0.02))
    for case in list(MAIN)[1:]:
        rows.append(Row(f"{case}: UCS over that of the brittle law ([Rojek 2003, fig. 5.2]: similar)", 1.0,
                        strength[case, "compression"] / strength["brittle", "compression"], 0.1, source=True))

    ucs = {case: mean(runs[f"small-{folder_of(case, 'compression', seed)}"].result("peak_stress") for seed in SEEDS)
           for case in SOFT}
    rows += [Row("damage: UCS at H = 5e9 over 2e11 ([Rojek 2003]: hardly sensitive)", 1.0,
                 ucs["damage 5e9"] / ucs["damage 2e11"], 0.1, source=True),
             Row("damage: UCS at H = 2e9 over 2e11 differs clearly ([Rojek 2003])", 1,
                 abs(ucs["damage 2e9"] / ucs["damage 2e11"] - 1) > 0.1, 0, source=True),
             Row("plastic: UCS rises with H from 2e9 to 2e10 ([Rojek 2003])", 1,
                 ucs["plastic 2e10"] > 1.1 * ucs["plastic 2e9"], 0, source=True)]
    curves = {test: {case: [main[case, test]] for case in MAIN} for test in TESTS}
    return rows, {"laws_stress_strain": figures.stress_strain(curves),
                  "laws_failure": figures.failures({case: main[case, "compression"] for case in MAIN})}


def sandstone(runs):
    """What the micro-parameters of [Rojek 2014, 5.2] give, against the reported rock."""
    def found(test, quantity):
        return mean(runs[folder_of("sandstone", test, seed)].result(quantity) for seed in SEEDS)

    rows = [row for name, run in runs.items() for row in balances(name, run)]
    return rows + [
        Row("Young's modulus", 1e-9 * published.value("p-5.1-e"), 1e-9 * found("compression", "youngs_modulus"), 1.8,
            "GPa", source=True),
        Row("Poisson's ratio", published.value("p-5.1-nu"), found("compression", "poissons_ratio"), 0.02, source=True),
        Row("compressive strength", 1e-6 * published.value("p-5.1-ucs"), 1e-6 * found("compression", "peak_stress"), 6,
            "MPa", source=True),
        Row("tensile strength", 1e-6 * published.value("p-5.1-st"), 1e-6 * found("tension", "peak_stress"), 0.7, "MPa",
            source=True)], {}


def slow_run(rock, test, seed, speed):
    """Name of a run of the section on the speed of loading."""
    return folder_of(f"{rock}-{speed}", test, seed)


def slow_enough(runs):
    """The default speed against half of it, mean of the packings."""
    rows = []
    for rock in ROCKS:
        for test in TESTS:
            for quantity, name in (("peak_stress", "strength"), ("youngs_modulus", "E")):
                default, slow = (mean(runs[slow_run(rock, test, seed, speed)].result(quantity) for seed in SEEDS)
                                 for speed in ("default", "slow"))
                rows.append(Row(f"bonds of [{rock}], {test}: {name} over that at {SLOW:g} m/s", 1.0, default / slow,
                                FAST_ENOUGH))
    return rows, {}


STRENGTHS = {"confined 0": ("UCS", "peak_stress", 0.06), "tension": ("tensile strength", "tensile_strength", 0.04)}
"""{test of campaigns.rock_laws: (words, result, part by which its mean may differ between radii)}."""


def kept(runs):
    """Strengths of a rock over those at the radii of its file, in the same packings: means of both."""
    of_file = f"{rock_laws.KEPT}, r = {500 * sum(rock_laws.KEPT_RADII):.3g} mm"
    return [Row(f"{case}: {words} over that at the file's radii", 1.0,
                mean(runs[rock_laws.folder_of(case, test, seed)].result(result) for seed in SEEDS) /
                mean(runs[rock_laws.folder_of(of_file, test, seed)].result(result) for seed in SEEDS), allowed)
            for case in rock_laws.CASES["kept"][0] if case != of_file
            for test, (words, result, allowed) in STRENGTHS.items()], {}


SECTIONS = [
    Section("Laboratory: the laws of [Rojek 2003, 5.1]", "The three laws; H on 525 discs of three packings.", laws,
            {**{folder_of(case, test, 1): uniaxial(test=test, **values)
                for case, values in MAIN.items() for test in TESTS},
             **{f"small-{folder_of(case, 'compression', seed)}": uniaxial(seed=seed, **SMALL, **values)
                for seed in SEEDS for case, values in SOFT.items()}}),
    Section("Laboratory: the sandstone of [Rojek 2014, 5.2]", "Its micro-parameters, mean of three packings; "
            "calibration/results/uniaxial.md explains the differences.", sandstone,
            {folder_of("sandstone", test, seed): uniaxial(test=test, seed=seed, **SANDSTONE)
             for seed in SEEDS for test in TESTS}),
    Section("Laboratory: slow enough", f"525 discs at the default speed and at {SLOW:g} m/s.", slow_enough,
            {slow_run(rock, test, seed, name): uniaxial(test=test, seed=seed, **SMALL, **values, **speed)
             for rock, values in ROCKS.items() for test in TESTS for seed in SEEDS
             for name, speed in (("default", {}), ("slow", {"speed": SLOW}))}),
    Section("Laboratory: a rock at other radii", f"{rock_laws.KEPT}, discs halved and doubled, three packings; "
            "calibration/results/rock_laws.md.", kept,
            {rock_laws.folder_of(case, test, seed): rock_laws.tests("kept", rock, seed)[test]
             for seed in SEEDS for case, rock in rock_laws.CASES["kept"][0].items() for test in STRENGTHS}),
]

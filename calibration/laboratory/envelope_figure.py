"""Strengths over confinement: tests, means of packings and fits in one figure, and how far one rock is from another.

Stresses are in Pa, compression positive; axes have MPa. Direct tension is a point at sigma3 = -strength, sigma1 = 0.
"""
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from rockwear.kernels.checks import ParameterError
from rockwear.kernels.strength_envelope import MohrCoulomb, hoek_brown, mohr_coulomb
from rockwear.report import palette, plots

MPA = 1e6
LEAST_PACKINGS = 3
"""Packings whose fits have a scatter worth a band."""
THIN, THICK = 0.7, 1.6
"""Widths of lines."""
FAINT = dict(markersize=3, alpha=0.3)
HOLLOW = dict(markersize=8, markerfacecolor="none", markeredgewidth=THICK, zorder=4)
"""Points of single tests, with and without a mean beside them."""


class Mean(NamedTuple):
    """Strength at one confinement: mean and standard deviation (nan: not known) of so many tests."""

    sigma3: float
    sigma1: float
    deviation: float
    tests: int


class Strengths(NamedTuple):
    """What is drawn of one rock, laboratory or model.

    words: its name; tests: ((sigma3, sigma1), ...) of single specimens, faint where there are means; means:
    (Mean, ...); fits: (MohrCoulomb, HoekBrown), as far as there are; of_packings: those of single packings, whose
    scatter is a band; most: largest sigma3 up to which fits are drawn, None for all; width: of their lines.
    """

    words: str
    colour: str
    tests: tuple = ()
    means: tuple = ()
    fits: tuple = ()
    of_packings: tuple = ()
    most: float | None = None
    width: float = THICK

    @property
    def least(self):
        """sigma3 of direct tension, 0 without: there the line of Mohr and Coulomb ends."""
        return min([0.0, *(place for place, *_ in self.means or self.tests)])

    def places(self, left, right):
        """(n,) sigma3 at which fits are drawn, between these at most."""
        return np.linspace(max(left, self.least), right if self.most is None else min(self.most, right), 400)


class Reference(NamedTuple):
    """What others are compared with.

    words: on it; sigma1: sigma1(sigma3) of arrays; allowed: ((sigma3 up to which, % that others may be off), ...); law:
    whether it is one, to which fits compare.
    """

    words: str
    sigma1: Callable
    allowed: tuple = ()
    law: bool = True


def through(tests):
    """(MohrCoulomb, HoekBrown) through ((sigma3, sigma1), ...), as far as these have them."""
    found = []
    for fit in (mohr_coulomb, hoek_brown):
        try:
            found.append(fit(*np.reshape(tests, (-1, 2)).T))
        except ParameterError:
            # None, or at one confinement alone; a sand, or points on a line.
            continue
    return tuple(found)


def of_packings(words, colour, points, tension=(), fits=None):
    """Strengths of tests on several packings.

    points: [{"sigma3": Pa, "peak_stress": Pa, "seed": of the packing}]; tension: Pa, of direct tension; fits: in place
    of those through all points. Such fits have no band.
    """
    by_stress, by_seed = {}, {}
    for point in points:
        pair = point["sigma3"], point["peak_stress"]
        by_stress.setdefault(pair[0], []).append(pair[1])
        by_seed.setdefault(point["seed"], []).append(pair)
    means = [Mean(sigma3, np.mean(found), np.std(found, ddof=1), len(found))
             for sigma3, found in sorted(by_stress.items()) if len(found) > 1]
    if len(tension) > 1:
        means.insert(0, Mean(-np.mean(tension), 0.0, np.nan, len(tension)))
    pairs = [pair for found in by_seed.values() for pair in found]
    alone = by_seed.values() if fits is None and len(by_seed) >= LEAST_PACKINGS else ()
    return Strengths(words, colour, tests=(*((-stress, 0.0) for stress in tension), *pairs), means=tuple(means),
                     fits=through(pairs) if fits is None else fits,
                     of_packings=tuple(fit for found in alone for fit in through(found)))


def off(means, sigma1):
    """[(sigma3, difference, standard error)] of means from sigma1(sigma3), Pa, in % of that; without tension."""
    found = []
    for mean in means:
        if mean.sigma3 >= 0:
            sought = float(sigma1(mean.sigma3))
            found.append((mean.sigma3, 100 * (mean.sigma1 / sought - 1),
                          100 * mean.deviation / np.sqrt(mean.tests) / sought))
    return found


def figure(shown, reference=None):
    """sigma1 over sigma3 of several Strengths, and below that how far they are from a Reference, if there is one."""
    if reference is None:
        drawn, (upper,) = plots.canvas(8, 5.5)
    else:
        drawn, (upper, lower) = plots.canvas(8, 8, 2, 1, height_ratios=(2, 1), sharex=True)
    places = [place for one in shown for place, *_ in (*one.tests, *one.means)]
    left, right = min(0.0, *places), max(places)
    margin = 0.04 * (right - left)
    handles = [handle for one in shown for handle in envelope(upper, one, right + margin)]
    upper.axhline(0, color=palette.GUIDE, linewidth=THIN, zorder=0)
    top = upper.get_ylim()[1]
    upper.set(xlim=((left - margin) / MPA, (right + margin) / MPA), ylim=(-0.03 * top, top),
              ylabel="σ1 at failure, MPa")
    if any(one.of_packings for one in shown):
        upper.set_title("bands: standard deviation of the fits to single packings", loc="right", fontsize=9)
    upper.legend(handles=handles, loc="lower right", bbox_to_anchor=(1.0, 0.04), fontsize=9)
    if reference is not None:
        differences(lower, shown, reference, right + margin)
    drawn.axes[-1].set_xlabel("σ3, MPa" + (" (direct tension: -σt)" if left < 0 else ""))
    return drawn


def envelope(axes, one, right):
    """Points, means with their standard deviation, and fits up to sigma3 = right, Pa. -> handles of the legend."""
    handles = []
    if one.tests:
        style = FAINT if one.means else HOLLOW
        handles = axes.plot(*np.transpose(one.tests) / MPA, "o", color=one.colour, label=one.words, **style)
    if one.means:
        sigma3, sigma1, deviation, tests = np.transpose(one.means)
        count = " to ".join(f"{number:g}" for number in np.unique([tests.min(), tests.max()]))
        handles = [axes.errorbar(sigma3 / MPA, sigma1 / MPA, deviation / MPA, fmt="o", color=one.colour, capsize=3,
                                 zorder=3, label=f"{one.words}: mean ± standard deviation ({count} packings)")]
    for fit in one.fits:
        at = one.places(-np.inf, right)
        sigma1 = fit.sigma1(at)
        alike = [other.sigma1(at) for other in one.of_packings if isinstance(other, type(fit))]
        if len(alike) >= LEAST_PACKINGS:
            spread = np.std(alike, axis=0, ddof=1)
            axes.fill_between(at / MPA, (sigma1 - spread) / MPA, (sigma1 + spread) / MPA, color=one.colour, alpha=0.1,
                              linewidth=0)
        if isinstance(fit, MohrCoulomb) and one.least < 0:
            # It ends in a cut-off.
            at, sigma1 = np.append(one.least, at), np.append(0.0, sigma1)
        handles += axes.plot(at / MPA, sigma1 / MPA, style_of(fit), color=one.colour, linewidth=one.width,
                             label=named(fit))
    return handles


def style_of(fit):
    """Of the line of a fit."""
    return "--" if isinstance(fit, MohrCoulomb) else "-"


def named(fit):
    """Words on a fit and its two numbers."""
    if isinstance(fit, MohrCoulomb):
        return f"Mohr-Coulomb: c {fit.cohesion.value / MPA:.3g} MPa, φ {fit.friction_angle.value:.1f}°"
    return f"Hoek-Brown: m_i {fit.m_i.value:.3g}, σci {fit.sigma_ci.value / MPA:.3g} MPa"


def differences(axes, shown, reference, right):
    """Means with their standard errors, single tests and fits of those without means, in % off the reference."""
    axes.axhline(0, color=palette.GUIDE, linewidth=THIN)
    least = 0.0
    for most, percent in reference.allowed:
        axes.fill_between([least / MPA, min(most, right) / MPA], -percent, percent, color=palette.TRUSTED, linewidth=0)
        least = most
    for one in shown:
        if one.means:
            sigma3, difference, error = np.transpose(off(one.means, reference.sigma1))
            axes.errorbar(sigma3 / MPA, difference, error, fmt="o", color=one.colour, capsize=3, zorder=3)
            continue
        sigma3, sigma1 = np.reshape([test for test in one.tests if test[0] >= 0], (-1, 2)).T
        axes.plot(sigma3 / MPA, 100 * (sigma1 / reference.sigma1(sigma3) - 1), "o", color=one.colour, **HOLLOW)
        at = one.places(0.0, right)
        for fit in one.fits if reference.law else ():
            axes.plot(at / MPA, 100 * (fit.sigma1(at) / reference.sigma1(at) - 1), style_of(fit), color=one.colour,
                      linewidth=one.width)
    axes.set(ylabel=f"off {reference.words}, %\n± standard error")

"""Figures of the campaign of grains: strengths, curves and failure over confinement, and one for each parameter of the
study."""
import numpy as np
from matplotlib.collections import LineCollection
from scipy.spatial import cKDTree

from calibration.campaigns.grains_tables import ELASTIC, STATED, STRENGTHS, table_2_fits, tested, trend_of
from calibration.campaigns.uniaxial_figures import CRACK, limits_of, thinned
from calibration.laboratory import envelope_figure
from rockwear.report import palette, published, shapes
from rockwear.report.plots import MM, canvas, discs, frame

NEAR = 2.5
"""Mean diameters within which particles tell the strain at one of them."""
ARROWS = {"rises": "↗", "falls": "↘", "unchanged": "→"}


def drawn(own, points, rows, slid):
    """(name, Figure) of all that the runs allow. own: {(test, seed): RunFolder} of the calibrated rock; points:
    {parameter: as of grains_tables.points}; rows: as of grains_tables.row_of; slid: RunFolders of rock pressed far past
    its peak."""
    if own:
        yield "grains_envelope", envelope(rows)
        yield "grains_curves", curves(own)
        yield "grains_failure", failures(own)
    if slid:
        yield "grains_sliding", sliding(slid)
    for parameter, by_property in points.items():
        if any(len(values) > 1 for values in by_property.values()):
            name = parameter.partition(",")[0].partition(" kn/")[0].replace(" ", "_")
            yield f"grains_{name}", parameter_figure(parameter, by_property)


def pressure(test):
    """MPa of confinement."""
    return float(test.split()[0]) if "MPa" in test else 0.0


def compressions(own):
    """Tests in compression, by confinement."""
    return sorted({test for test, _ in own if test != "tension"}, key=pressure)


def envelope(rows):
    """Strengths of the calibrated rock beside table 2 of [Bahaaddini 2018], as its fig. 10."""
    laboratory = _of_source("laboratory", "laboratory [Bahaaddini 2018]", palette.PUBLISHED)
    model = _of_source("model", "model of [Bahaaddini 2018]", palette.EXACT)._replace(width=envelope_figure.THIN)
    ours = envelope_figure.of_packings("ours", palette.SIMULATED, *tested(rows))
    line = laboratory.fits[0]
    return envelope_figure.figure([ours, laboratory, model],
                                  envelope_figure.Reference("the laboratory's line", line.sigma1))


def _of_source(of, words, colour):
    """Strengths of "laboratory" or "model" by table 2, whose tests under confinement are in lines alone."""
    tension, ucs = (published.value(f"v-table2-{name}-{of}") for name in ("tensile_strength", "ucs"))
    return envelope_figure.Strengths(words, colour, tests=((-tension, 0.0), (0.0, ucs)), fits=table_2_fits(of))


def curves(own):
    """Stress over strain: the first packing bold, the others thin [Bahaaddini 2018, figs 6, 8]."""
    figure, (left, right) = canvas(10, 4.2, 1, 2, width_ratios=(1.6, 1))
    for axes, tests in ((left, compressions(own)), (right, ["tension"])):
        for k, test in enumerate(tests):
            runs = [run for (name, _), run in sorted(own.items()) if name == test]
            for run in runs[::-1]:
                first = run is runs[0]
                strain = thinned(run.column("platen_strain"))
                axes.plot(100 * strain, 1e-6 * thinned(run.column("stress")) - pressure(test), color=f"C{k}",
                          linewidth=1.8 if first else 0.6, alpha=1 if first else 0.45,
                          label=f"{pressure(test):g} MPa" if first else None)
        axes.set(xlabel="strain between the platens, %", ylim=(0, None), xlim=(0, None))
    left.set(title="compression over confinement", ylabel="σ₁ - σ₃, MPa")
    left.legend(title="σ₃", fontsize=9)
    right.set(title="direct tension", ylabel="stress, MPa")
    return figure


def failures(own):
    """Cracks in the grains at the end of each test of the first packing, loaded from left and right."""
    tests = ["tension", *compressions(own)]
    seed = min(seed for _, seed in own)
    tests = [test for test in tests if (test, seed) in own]
    figure, panels = canvas(11, 2.5 * -(-len(tests) // 3), -(-len(tests) // 3), 3)
    for axes in panels[len(tests):]:
        axes.set_axis_off()
    for axes, test in zip(panels, tests):
        failure(axes, own[test, seed], f"σ₃ = {pressure(test):g} MPa" if test != "tension" else test)
    return figure


def failure(axes, run, title):
    """Grains in pale colours, broken bonds between them as red lines."""
    model, shot = run.model, run.snapshot(-1)
    places, radii = shot["rock_positions"], model["rock_radii"]
    colour = np.random.default_rng(1).random(int(model["grains"].max()) + 1)[model["grains"]]
    discs(axes, places, 1.1 * radii, array=colour, cmap="Pastel2", linewidths=0)
    broken = model["bonds"][shot["status"] != 0]
    axes.add_collection(LineCollection(MM * shapes.cracks(places, radii, broken, near=2), colors=CRACK, linewidths=1))
    frame(axes, limits_of(run), f"{title}: {len(broken)} broken")
    axes.set_xlabel("")


def sliding(runs):
    """Where rock that is pressed far past its peak shears [Bahaaddini 2018, fig. 9], and its stress over strain."""
    figure, panels = canvas(5 * len(runs), 6, 2, len(runs))
    for axes, below, run in zip(panels, panels[len(runs):], runs):
        first, last = (run.snapshot(k)["rock_positions"] for k in (0, -1))
        radii = run.model["rock_radii"]
        strain = shear_strain(first, last, 2 * NEAR * radii.mean())
        sheared = discs(axes, last, 1.1 * radii, array=strain, cmap="magma_r", linewidths=0, clim=(0, 0.5))
        figure.colorbar(sheared, ax=axes, label="largest shear strain", shrink=0.6)
        left, right, low, high = limits_of(run)
        bulge = MM * np.ptp(last[:, 1]) - MM * run.model["box"][1]
        pressed, seed = 1e-6 * run.parameter("confinement"), run.parameter("seed")
        frame(axes, (left, right, low - bulge, high + bulge), f"σ₃ = {pressed:g} MPa, packing {seed:g}")
        below.plot(100 * thinned(run.column("platen_strain")), 1e-6 * thinned(run.column("stress")))
        below.set(xlabel="strain between the platens, %", ylabel="σ₁, MPa", xlim=(0, None), ylim=(0, None))
    return figure


def shear_strain(places, now, near):
    """(n,) largest shear strain at each particle, half the difference of the principal values of Green's strain (F^T F
    - 1)/2, F fitted to the relative motion of those nearer than `near` (m); nan of fewer than three.

    places, now: (n, 2) m, before and after.
    """
    found = np.full(len(places), np.nan)
    for n, others in enumerate(cKDTree(places).query_ball_point(places, near)):
        if len(others) > 3:
            gradient = np.linalg.lstsq(places[others] - places[n], now[others] - now[n], rcond=None)[0]
            low, high = np.linalg.eigvalsh(0.5 * (gradient @ gradient.T - np.eye(2)))
            found[n] = 0.5 * (high - low)
    return found


def parameter_figure(parameter, by_property):
    """Strengths and elastic constants over a parameter, each over its mean; packings as points, means as lines."""
    figure, panels = canvas(9, 3.6, 1, 2)
    for axes, names in zip(panels, (STRENGTHS, ELASTIC)):
        for k, (name, words) in enumerate(names.items()):
            values = by_property.get(name, {})
            if len(values) < 2:
                continue
            mean = np.mean([np.mean(ys) for ys in values.values()])
            places = list(values)
            axes.plot(places, [np.mean(values[x]) / mean for x in places], "-", color=f"C{k}",
                      label=f"{words}: {_words(parameter, name, values)}")
            for x, ys in values.items():
                axes.plot([x] * len(ys), np.array(ys) / mean, "o", color=f"C{k}", markersize=4, alpha=0.6)
        axes.set(xlabel=parameter, xscale="log", ylim=(0, None))
        axes.set_xticks(places, [f"{x:.3g}" for x in places])
        axes.minorticks_off()
        axes.legend(fontsize=8, title="[Bahaaddini 2018] | ours", title_fontsize=8)
    panels[0].set(title="strengths over their mean")
    panels[1].set(title="elastic constants over their mean")
    return figure


def _words(parameter, name, values):
    """The stated trend and ours."""
    stated, law = STATED.get(parameter, {}).get(name), trend_of(values)
    return f"{ARROWS.get(stated, '?')} | {ARROWS.get(law.word, '?') if law else '?'}"

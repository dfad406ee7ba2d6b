"""Accuracy and cost of heat conduction: conductances of packings, convergence, processor time.

    python3 -m calibration.benchmarks.heat DIR

Writes heat.md (tables), figures and provenance.json into DIR. Kernels only, without YADE; takes some minutes. SECTIONS
are sections of `make validate`. Times of a heat step are processor times, medians of five rounds.
"""

import matplotlib
import numpy as np

from calibration import command, generated
from calibration.benchmarks import heat_studies as studies
from calibration.benchmarks.heat_figures import convergence_figure, models_figure, tip_figure
from calibration.benchmarks.heat_studies import order
from calibration.validation.verdicts import Row, Section
from rockwear.report import plots


def tip_tables(by_size, by_visit):
    """Errors of the temperature of a heated face, as lines of Markdown."""
    return ["## Temperature of a heated face", "",
            "Error against the exact temperature; heat has penetrated to the depth sqrt(a t).", "",
            *generated.table(["node diameter / sqrt(a t)", "error of the node, %", "extrapolated to the face, %"],
                             [[f"{size:g}", f"{100 * node:+.1f}", f"{100 * face:+.1f}"]
                              for size, node, face in by_size]),
            "Additional error of visits that add the heat collected since the last visit:", "",
            *generated.table(
                ["time between visits / time of heating", *(f"diameter {size:g} sqrt(a t), %" for size in by_visit)],
                [[f"{visit:g}", *(f"{100 * rows[k][1]:+.2f}" for rows in by_visit.values())]
                 for k, visit in enumerate(studies.VISITS)])]


def curve(folder):
    """For make bench: error of the tip's temperature against node size and visit period, as lines and a figure."""
    tip = studies.tip_errors()
    with matplotlib.rc_context(plots.STYLE):
        tip_figure(*tip).savefig(folder / "heat_tip.png")
    generated.record(folder / "heat_tip.png")
    return tip_tables(*tip)


def conductivity_rows(found):
    """Rows of the table of conductivities, in %."""
    for name, models in found.items():
        for model, values in models.items():
            off = 100 * (values[:, :2].mean(axis=1) - 1)
            between = 100 * np.abs(values[:, 0] / values[:, 1] - 1).max()
            yield [name, model, f"{off.mean():+.2f}", f"{off[np.abs(off).argmax()]:+.2f}", f"{between:.2f}",
                   f"{100 * values[:, 2].mean():.2f}"]


def tables(found, space, in_time, tip, seconds):
    """All tables, as lines of Markdown."""
    return [
        "## Conductivity of random packings", "",
        f"Deviation from the material's conductivity ({studies.SIDE * 1e3:g} mm square, smallest radius "
        f"{studies.SMALLEST * 1e3:g} mm, seeds {', '.join(map(str, studies.SEEDS))}): mean of both directions (mean "
        "over seeds, and the worst seed); largest difference of the two directions in a sample of some hundred "
        "particles; rms deviation of steady temperatures from a linear field, over its range.", "",
        *generated.table(["packing", "model", "mean, %", "worst seed, %", "x against y, %", "temperatures, %"],
                         conductivity_rows(found)),
        "## Convergence", "",
        "Step of the face temperatures [Rojek 2003, 7.6.3] on random packings, t = 0.05 L²/a, against the exact one.",
        "",
        *generated.table(["diameters across", "rms error, % of the step", "largest, %"],
                         [*([n, f"{100 * rms:.4f}", f"{100 * largest:.4f}"] for n, rms, largest in space),
                          ["order", f"{-order(space):.2f}", f"{-order(space, 2):.2f}"]]),
        *generated.table(["heat step over the stable one", "rms error of the step, %",
                          "of step and size (40 across), %"],
                         [*([f"{f:g}", f"{100 * fine:.4f}", f"{100 * exact:.4f}"] for f, fine, exact in in_time),
                          ["order up to 0.5", f"{order(in_time[1:]):.2f}", ""]]),
        *tip_tables(*tip),
        "## Cost", "",
        f"Processor time on one core, {seconds['nodes']:,} nodes and {seconds['contacts']:,} contacts.", "",
        *generated.table(["operation", "time"], [
            ["heat step", f"{1e3 * seconds['heat_step']:.1f} ms"],
            ["new matrix after a change of contacts", f"{1e3 * seconds['rewire']:.0f} ms"],
            ["its stable step", f"{1e3 * seconds['stable_step']:.0f} ms"],
            ["Voronoi cells, once a run", f"{seconds['cells']:.1f} s"]])]


def benchmarks(runs):
    """Errors and orders of the three benchmarks of [Rojek 2003, 7.6] on three packings."""
    result, rows = runs["heat_benchmarks"].result, []
    for name in ("slab_source", "half_space", "jump"):
        for kind in ("random", "square", "triangular"):
            words = f"{name.replace('_', ' ')}, {kind}"
            rows += [Row(f"{words}: largest error, of the range", 0.0, result(f"{name}_{kind}_largest_error"), 0.005),
                     Row(f"{words}: order in space at least 1.7", 1, result(f"{name}_{kind}_order_in_space") > 1.7, 0)]
    return rows, {}


def conductances(runs):
    """Conductivity of packings without and with a fit, and orders of convergence."""
    found, space, in_time = studies.conductivities(), studies.errors_in_space(), studies.errors_in_time()
    rows = []
    for name, models in found.items():
        for model in ("Voronoi cells", "fitted to each packing"):
            worst = models[model][:, :2].mean(axis=1)
            rows.append(Row(f"{name}, {model}: conductivity over the material's", 1.0,
                            float(worst[np.abs(worst - 1).argmax()]), 1e-6))
    rows += [Row("order in space of [Rojek 2003, 7.6.3] on random packings", 2.0, -order(space), 0.3),
             Row("order in time", 1.0, order(in_time[1:]), 0.15)]
    return rows, {"conductances": models_figure(found), "heat_convergence": convergence_figure(space, in_time)}


SECTIONS = [
    Section("Heat benchmarks", "[Rojek 2003, 7.6] on three packings: the largest error of any disc at any output time.",
            benchmarks, {"heat_benchmarks": ("yade_scripts/heat_benchmarks.py", {})}),
    Section("Conductances", "Conductivity of packings by the faces of their Voronoi cells, by a fit, and by bars.",
            conductances)]


def main(folder):
    """All studies, figures and tables."""
    folder.mkdir(parents=True, exist_ok=True)
    found, space, in_time = studies.conductivities(), studies.errors_in_space(), studies.errors_in_time()
    tip, seconds = studies.tip_errors(), studies.cost()
    with matplotlib.rc_context(plots.STYLE):
        models_figure(found).savefig(folder / "heat_conductances.png")
        convergence_figure(space, in_time).savefig(folder / "heat_convergence.png")
        tip_figure(*tip).savefig(folder / "heat_tip.png")
    generated.record(*(folder / f"heat_{name}.png" for name in ("conductances", "convergence", "tip")))
    print(generated.write_page(folder / "heat.md", tables(found, space, in_time, tip, seconds)))


if __name__ == "__main__":
    main(command.folder(__spec__.name, "out/heat"))

"""What a rock fit leaves: rock.json, fit.md with its answer first, a figure, and a line for each step."""
import json

import matplotlib
import numpy as np

from calibration import generated
from calibration.fitting import rock_envelope
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.strength_envelope import mohr_coulomb
from rockwear.model.rock_file import FORMAT, PROPERTIES, read
from rockwear.report import plots
from rockwear.scenes.parameters import OF_ROCK

ENVELOPE = "envelope.png"
"""Figure of strengths over confinement."""
SCALES = {"Pa": (1e6, "MPa"), "Pa sqrt(m)": (1e6, "MPa sqrt(m)"), "": (1, "")}
STRENGTHS = "ucs", "tensile_strength"
NEAR = 0.05
"""Difference of UCS over tensile strength from what was asked for, over it, that is not for want of other grains."""


def shown(observable, value):
    """A value of an observable, in MPa where it is a stress."""
    factor, unit = SCALES[observable.unit]
    if observable.name == "youngs_modulus":
        factor, unit = 1e9, "GPa"
    return f"{value / factor:.3g} {unit}".strip()


def progress(step):
    """One line on a step."""
    parts = [f"{o.name} {shown(o, float(np.nanmean(values)))} ({off(o, values)})" for o, values in step.values.items()]
    return f"{step.seconds / 60:5.1f} min  {step.stage:8s} {', '.join(parts)}"


def off(observable, values):
    """Words on the difference of the mean from the target."""
    difference = float(np.nanmean(values)) - observable.target
    return f"{difference:+.3f}" if observable.kind == "nu" else f"{100 * difference / observable.target:+.1f} %"


def allowed(observable):
    """Words on the difference from the target that is allowed."""
    return f"{observable.tolerance:.3f}" if observable.kind == "nu" else f"{100 * observable.allowed:g} %"


def answer(found, micro):
    """Lines that say what was reached, what was not, and of what the packings do not tell."""
    missed, untold = ([o for o, one in found.verdicts.items() if is_so(one)]
                      for is_so in (lambda one: one.missed, lambda one: not one.told))
    count = " to ".join(map(str, sorted({one.count for one in found.verdicts.values()})))
    met = len(found.verdicts) - len(missed) - len(untold)
    part = "All" if met == len(found.verdicts) else f"{met} of"
    lines = [f"{part} {len(found.verdicts)} targets are met, on {count} packings that the fit has not seen."]
    if missed:
        words = ", ".join(f"{o.name} ({shown(o, found.verdicts[o].mean)} instead of {shown(o, o.target)}, standard "
                          f"error {shown(o, found.verdicts[o].error)})" for o in missed)
        lines[0] += f" Not reached: {words}."
    if untold:
        words = ", ".join(f"{o.name} ({shown(o, found.verdicts[o].mean)}, standard error "
                          f"{shown(o, found.verdicts[o].error)}, target {shown(o, o.target)}, allowed "
                          f"{allowed(o)})" for o in untold)
        lines[0] += f" Not told, because packings scatter by more than is allowed: {words}."
    bounds = micro.at_bounds(found.x)
    if bounds:
        lines.append(f"At the end of its range: {', '.join(bounds)}. The bond law {micro.law} cannot come nearer.")
    if any(word.startswith("length") for word in bounds):
        lines.append("The bonds are all but brittle: toughness then grows with the strength and the square root of the "
                     "radius. A less tough rock takes smaller radii.")
    lines += _grains_needed(found, micro, missed)
    if found.not_failed:
        lines.append("In some tests stress had not fallen by a fifth when they ended: "
                     f"{', '.join(found.not_failed)}. Their strengths are the largest stress up to there.")
    if found.failures:
        lines.append(f"Left out: {'; '.join(found.failures)}.")
    return lines


def _grains_needed(found, micro, missed):
    """Lines on grains of another size, where UCS over tensile strength is what was missed."""
    over = {o.name: one.mean / o.target for o, one in found.verdicts.items() if o.name in STRENGTHS}
    ratio = over["ucs"] / over["tensile_strength"]
    if not {o.name for o in missed} & set(STRENGTHS) or not abs(ratio - 1) >= NEAR:
        return []
    return [f"UCS over tensile strength is {ratio:.2f} of what was asked for. It rises with the grain_edge, which is "
            f"{micro.given.get('grain_edge', 0.0):g} m here: a {'longer' if ratio < 1 else 'shorter'} one may come "
            "nearer."]


def envelope(found, micro):
    """{property: (values (packings,), unit)} of Mohr and Coulomb, of the packings on which all its strengths were
    measured; nothing without confined strengths."""
    values = found.steps[-1].values
    points = [o for o in micro.observables if o.kind == "confined"]
    if not points:
        return {}
    points.insert(0, next(o for o in micro.observables if o.name == "ucs"))
    # Each in the order of the seeds: fewer packings are confined than not, the first ones.
    whole = [strengths for strengths in zip(*(values[o] for o in points)) if np.isfinite(strengths).all()]
    try:
        lines = [mohr_coulomb([o.confinement for o in points], strengths) for strengths in whole]
    except ParameterError:
        # Strengths of some packing that do not rise with the confinement.
        return {}
    if len(lines) < 2:
        return {}
    return {name: (np.array([getattr(line, name).value for line in lines]), PROPERTIES[name][0])
            for name in ("cohesion", "friction_angle")}


def write(folder, found, *, micro, targets, values):
    """Write rock.json, fit.md and fit.png, and envelope.png of a rock with confined strengths, into `folder`."""
    rock = rock_file(found, micro=micro, targets=targets, values=values)
    written = [folder / "rock.json", folder / "fit.png"]
    written[0].write_text(json.dumps(rock, indent=1) + "\n", encoding="utf-8")
    with matplotlib.rc_context(plots.STYLE):
        figure(found, micro).savefig(written[1])
        if "triaxial" in rock["plane"]["measured"]:
            written.append(folder / ENVELOPE)
            rock_envelope.draw(*rock_envelope.compared(read(written[0], OF_ROCK))).savefig(written[2])
    generated.record(*written)
    generated.write_page(folder / "fit.md", page(found, micro=micro, targets=targets, values=values))


def measured(verdicts):
    """{property: what the laboratory measured of it} of {Observable: Verdict}, as a rock file has it."""
    return {o.name: {"mean": one.mean, "standard_deviation": one.deviation, "packings": one.count, "unit": o.unit}
            for o, one in verdicts.items()}


def rock_file(found, *, micro, targets, values):
    """The rock as a dict of the format of rockwear.model.rock_file."""
    of_rock = measured({o: one for o, one in found.verdicts.items() if o.test != "triaxial"})
    confined = {o: one for o, one in found.verdicts.items() if o.test == "triaxial"}
    if confined:
        of_rock["triaxial"] = {"mean": [[o.confinement, one.mean] for o, one in confined.items()],
                               "standard_deviation": [one.deviation for one in confined.values()],
                               "packings": next(iter(confined.values())).count, "unit": "Pa"}
    for name, (values_of, unit) in envelope(found, micro).items():
        of_rock[name] = {"mean": float(values_of.mean()), "standard_deviation": float(values_of.std(ddof=1)),
                         "packings": len(values_of), "unit": unit}
    return {"format": FORMAT, "name": values["name"], "source": values["source"],
            "targets": {name: {"value": value, "unit": PROPERTIES[name][0]}
                        for name, value in targets.as_properties().items()},
            "plane": {"parameters": micro.parameters(found.x),
                      "resolution": {name: values[name] for name in ("radius_min", "radius_max")},
                      "measured": of_rock}}


def page(found, *, micro, targets, values):
    """Lines of fit.md."""
    lines = [f"# {values['name']}: {values['source']}", "", " ".join(answer(found, micro)), ""]
    lines += generated.table(
        ["", "target", "mean ± standard deviation", "packings", "standard error", "difference", "allowed", "met"],
        [[o.name, shown(o, o.target), f"{shown(o, one.mean)} ± {shown(o, one.deviation)}", one.count,
          shown(o, one.error), off(o, [one.mean]), allowed(o),
          "yes" if one.met else "**no**" if one.told else "**not told**"]
         for o, one in found.verdicts.items()])
    lines += [f"Discs of {radii(values)} mm; specimens of {found.specimens}.", ""]
    if targets.left_out:
        lines += [targets.left_out, ""]
    for name, (values_of, unit) in envelope(found, micro).items():
        wanted = getattr(targets, name, None)
        lines += [f"{name}: {values_of.mean():.4g} ± {values_of.std(ddof=1):.2g} {unit}"
                  + (f", target {wanted:g}" if wanted else "") + f" ({len(values_of)} packings).", ""]
    if any(o.test == "triaxial" for o in found.verdicts):
        lines += [f"![σ1 over σ3]({ENVELOPE})", ""]
    lines += ["![steps](fit.png)", "", "## Micro-parameters", ""]
    lines += generated.table(["parameter", "value"], list(micro.parameters(found.x).items()))
    errors = ", ".join(f"{name} {100 * error:.1f} %" for name, error in zip(micro.names, found.error))
    others = (" (`python3 -m calibration.fitting.size_powers` finds how they follow the radius.)"
              if micro.law == "cohesive" else "")
    lines += [f"They hold at radii of {radii(values)} mm in the plane.{others} Standard errors of what was "
              f"varied, from the scatter of packings: {errors}."
              + (f" Not varied: {', '.join(micro.fixed)}, for want of a target." if micro.fixed else ""), ""]
    lines += ["## Steps", "", "Means over the packings of each stage; minutes since the start, without runs kept from "
              "an earlier one:", ""]
    lines += generated.table(
        ["stage", "min", *micro.names, *(o.name for o in micro.observables)],
        [[step.stage, f"{step.seconds / 60:.1f}", *(f"{value:.4g}" for value in np.exp(step.x)),
          *(f"{shown(o, float(np.nanmean(step.values[o])))} ({off(o, step.values[o])})" for o in micro.observables)]
         for step in found.steps])
    return lines


def radii(values):
    """Words on the radii, in mm."""
    return " to ".join(f"{1e3 * values[name]:g}" for name in ("radius_min", "radius_max"))


def figure(found, micro):
    """Measured over target, step by step, and each packing of the last check. A Poisson's ratio of 0 is left out."""
    drawn, (axes,) = plots.canvas(7.5, 4.5)
    for number, o in enumerate(one for one in micro.observables if one.target):
        colour = f"C{number}"
        axes.plot([np.nanmean(step.values[o]) / o.target for step in found.steps], "o-", color=colour, label=o.name,
                  markersize=4)
        last = found.steps[-1].values[o] / o.target
        axes.plot(np.full(len(last), len(found.steps) - 0.6 + 0.08 * number), last, "x", color=colour)
    names = [step.stage for step in found.steps]
    axes.set_xticks([*range(len(names)), len(names) - 0.4], [*names, "packings"], rotation=60)
    axes.axhspan(0.95, 1.05, color="0.9", zorder=0)
    axes.set(ylabel="measured / target")
    axes.legend(fontsize=8, ncol=4, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return drawn

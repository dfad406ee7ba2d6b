"""How far the acceleration of wear can be trusted, by the two rules of [Rocky] and the recession of facets."""
import math

import numpy as np

from rockwear.kernels import wear_statistics
from rockwear.report import palette
from rockwear.report.folder import read_history
from rockwear.report.page import Section, number, percent, quantity
from rockwear.report.plots import MM, canvas, save


def trust(run):
    """Section on the acceleration."""
    if not math.isfinite(run.result("trusted_wear_acceleration")):
        return None
    return Section("How far the acceleration can be trusted", in_words(run), [" ", save(run, "trust", figure(run))])


def in_words(run):
    """What the rules say of this run."""
    piece = "a layer as deep as its facet" if "tool_facets" in run.model else "a particle"
    error = run.result("wear_distribution_error")
    known = f"is known to {percent(error, 1.0)}" if math.isfinite(error) else "cannot be told: the run is too short"
    events = run.result("contact_events_per_particle")
    # Of a tool that keeps its shape no piece ever goes.
    goes = f", and {piece} wears away in {number(events)} contact events" if math.isfinite(events) else ""
    enough = f" and {wear_statistics.ENOUGH_EVENTS} events" if goes else ""
    recession = run.result("recession_per_slip")
    recedes = f" Its face recedes by {number(recession)} of the way that rock slides on it." if recession > 0 else ""
    slow = f" and a recession of {wear_statistics.RECESSION:g} at most" if recedes else ""
    trusted, factor = run.result("trusted_wear_acceleration"), run.parameter("wear_acceleration")
    longer = ""
    if trusted < factor:
        longer = ", and run as much longer"
    elif not math.isfinite(error):
        longer = ", and run longer to tell the distribution"
    return (f"Wear is accelerated {quantity(factor, '-')} times. Sampled in "
            f"{quantity(run.result('simulated_time'), 's')}, its distribution along the tool {known}{goes}.{recedes} "
            f"For an error of {percent(run.parameter('wear_tolerance'), 1.0)}{enough}{slow}, accelerate at most "
            f"{number(trusted)} times{longer}.")


def figure(run):
    """Wear along the outline with its own error, and error and events against the acceleration."""
    columns = read_history(run.path / "wear_profile.csv")[0]
    increments = np.column_stack(list(columns.values())) if columns else []
    deviation = wear_statistics.distribution_deviation(increments) if len(increments) else None
    factor = run.parameter("wear_acceleration", 0.0)
    if deviation is None or not factor:
        return None
    drawn, (along, against) = canvas(12, 4.8, 1, 2)
    draw_profile(run, along, increments.sum(axis=0), deviation)
    draw_rules(run, against, factor)
    return drawn


def draw_profile(run, axes, worn, deviation):
    """Share of the worn volume by place along the outline, with its standard error."""
    outline = run.model["outline"]
    place, length = MM * wear_statistics.middles(outline, len(worn)), MM * wear_statistics.place_length(outline)
    axes.bar(place, 100 * worn / worn.sum(), 0.9 * length, color=palette.BAR,
             yerr=100 * deviation / worn.sum(), ecolor=palette.BAR_ERROR)
    shown = place[worn > 1e-3 * worn.max()]
    axes.set(xlabel="arc length from the tip along the new outline / mm", ylabel="% of the worn volume", ylim=(0, None),
             xlim=(shown.min() - 2 * length, shown.max() + 2 * length),
             title="where the tool wears, and how well that is known")


def draw_rules(run, axes, factor):
    """Error of the distribution and contact events over the acceleration, at the same worn volume."""
    factors = factor * np.geomspace(1e-3, 10, 60)
    axes.loglog(factors, 100 * run.result("wear_distribution_error") * np.sqrt(factors / factor), color=palette.ERROR,
                label="error of the distribution / %")
    axes.axhline(100 * run.parameter("wear_tolerance"), color=palette.ERROR, linestyle=":",
                 label="largest error wanted")
    events = run.result("contact_events_per_particle")
    if math.isfinite(events):
        axes.loglog(factors, events * factor / factors, color=palette.EVENTS,
                    label="contact events until a piece is worn away")
        axes.axhline(wear_statistics.ENOUGH_EVENTS, color=palette.EVENTS, linestyle=":", label="fewest events wanted")
    axes.axvspan(factors[0], run.result("trusted_wear_acceleration"), color=palette.TRUSTED, zorder=-5,
                 label="the rules are kept")
    axes.axvline(factor, color=palette.GUIDE, linewidth=1.5, label="this run")
    axes.set(xlabel="wear acceleration, at the same worn volume", xlim=factors[[0, -1]])
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), fontsize=8, ncols=2)

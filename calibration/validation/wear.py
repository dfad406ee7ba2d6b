"""Validation of wear: the virtual sliding test returns the wear coefficient it was given, for the tests of
[Rojek 2003, 6.6] and for rising temperatures, and a tool of segments wears like one of particles."""
import math
import statistics

from calibration.campaigns import two_tools
from calibration.validation.verdicts import Row, Section
from rockwear.report.plots import MM, canvas

SCRIPT = "yade_scripts/sliding_wear.py"
COLUMNS = "hardness_table", "wear_coefficient", "force", "area", "temperature"
ROWS = {"lab_MET71_34MPa": dict(zip(COLUMNS, ("MET71", 0.0023, 885, 26e-6, 429.15))),
        "lab_MET71_28MPa": dict(zip(COLUMNS, ("MET71", 0.0028, 840, 30e-6, 419.15))),
        "lab_MET91_9.1MPa": dict(zip(COLUMNS, ("MET91", 0.0113, 622, 68e-6, 401.15))),
        "lab_MET91_9.0MPa": dict(zip(COLUMNS, ("MET91", 0.01125, 1237, 138e-6, 486.15)))}
"""[Rojek 2003, eqs. 6.12-6.15, tables 6.2 and 6.3]."""
RISING = {f"{name}_heating_by_350K": {**ROWS[name], "temperature_rise": 350}
          for name in ("lab_MET71_34MPa", "lab_MET91_9.0MPa")}
ALLOWED, ALLOWED_RISING = 1e-3, 5e-3
"""Relative deviation of k, at a constant and at a rising temperature."""


def laboratory(runs):
    """k returned over k given, from the lost depth and the known force; the balance of the volume."""
    rows = []
    figure, (axes,) = canvas(7, 4.5)
    for name, run in runs.items():
        mass, words = run.summary["balances"]["mass"], name.replace("_", " ")
        returned = run.result("k_returned") / run.result("k_given")
        rows += [Row(f"{words}: k returned over k given", 1.0, returned, ALLOWED_RISING if name in RISING else ALLOWED),
                 Row(f"{words}: removed volume over Archard's", 1.0, 1 + mass["unexplained"] / mass["archard"], 1e-9)]
        line, = axes.plot(run.column("distance"), MM * run.column("worn_depth"), linewidth=1.2, label=words)
        axes.plot(run.column("distance"), MM * run.column("expected_depth"), color=line.get_color(), linewidth=4,
                  alpha=0.3)
    axes.set(xlabel="distance / m", ylabel="worn depth / mm", xlim=(0, None), ylim=(0, None))
    axes.legend(fontsize=8)
    return rows, {"laboratory_wear": figure}


SEEDS = (1, 2, 3)
TOOLS = {"particles": {"removal": "none"}, "segments": {"reshape": "false"}}
SAME_CUT = dict(start_up=0.003, cycles=0, grading_factor=3, heat="false")


def both_tools(runs):
    """Worn volume and friction of the two tools, whose means may differ by the scatter of their packings."""
    groups, rows = two_tools.grouped(runs.values()), []
    for quantity, unit, of in (("worn volume, unaccelerated", "um2", lambda run: 1e12 * two_tools.worn_once(run)),
                               ("friction, % of the tool's work", "",
                                lambda run: 100 * two_tools.share_of_friction(run))):
        particles, segments = ([of(run) for run in found] for found in groups.values())
        rows.append(Row(f"{quantity}: segments against particles", statistics.mean(particles),
                        statistics.mean(segments),
                        math.hypot(statistics.stdev(particles), statistics.stdev(segments)), unit))
    return rows, {"two_tools": two_tools.figure(groups)}


SECTIONS = [
    Section("Laboratory wear test", "A block under a known load slides and wears [Rojek 2003, 6.6]. Thin: simulated; "
            "broad: the law under the known force, integrated over the temperature along the distance.", laboratory,
            {name: (SCRIPT, {**values, "report": "false"}) for name, values in {**ROWS, **RISING}.items()}),
    Section("Particles or segments", "The same tooth in the same three packings, its shape kept, as particles and as "
            "segments; the scatter of single packings of both tools together is allowed.", both_tools,
            {f"{tool}_{seed}": ("yade_scripts/tooth_cycles.py", {"tool": tool, "seed": seed, **SAME_CUT, **kept})
             for tool, kept in TOOLS.items() for seed in SEEDS}),
]

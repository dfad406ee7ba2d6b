"""Validation of wear: the laboratory test of M 6.6 returns what it was given, for M's rows and rising temperatures."""
from calibration.verdicts import Row, Section
from rockwear.report.plots import MM, canvas

SCRIPT = "yade_scripts/lab_wear.py"
ROWS = {"lab_MET71_34MPa": dict(steel="MET71", wear_coefficient=0.0023, force=885, area=26e-6, temperature=429.15),
        "lab_MET71_28MPa": dict(steel="MET71", wear_coefficient=0.0028, force=840, area=30e-6, temperature=419.15),
        "lab_MET91_9.1MPa": dict(steel="MET91", wear_coefficient=0.0113, force=622, area=68e-6, temperature=401.15),
        "lab_MET91_9.0MPa": dict(steel="MET91", wear_coefficient=0.01125, force=1237, area=138e-6, temperature=486.15)}
"""M 6.12-6.15, tables 6.2 and 6.3."""
RISING = {f"{name}_heating_by_350K": {**ROWS[name], "temperature_rise": 350}
          for name in ("lab_MET71_34MPa", "lab_MET91_9.0MPa")}


def laboratory(runs):
    """k returned over k given, by the depth the block has lost and the known force, and where Archard's volume is."""
    rows = []
    figure, (axes,) = canvas(7, 4.5)
    for (name, run), allowed in zip(runs.items(), [1e-3] * len(ROWS) + [5e-3] * len(RISING)):
        mass, words = run.summary["audits"]["mass"], name.replace("_", " ")
        returned = run.result("k_returned") / run.result("k_given")
        rows += [Row(f"{words}: k returned over k given", 1.0, returned, allowed),
                 Row(f"{words}: Archard's volume found again", 1.0, 1 + mass["unexplained"] / mass["archard"], 1e-9)]
        line, = axes.plot(run.column("distance"), MM * run.column("worn_depth"), linewidth=1.2, label=words)
        axes.plot(run.column("distance"), MM * run.column("expected_depth"), color=line.get_color(), linewidth=4,
                  alpha=0.3)
    axes.set(xlabel="distance / m", ylabel="worn depth / mm", xlim=(0, None), ylim=(0, None))
    axes.legend(fontsize=8)
    return rows, {"laboratory_wear": figure}


SECTIONS = [
    Section("Laboratory wear test", "A block under a known load slides and wears (M 6.6). Thin: simulated; broad: the "
            "law under the known force, integrated over the temperature on the way.", laboratory,
            {name: (SCRIPT, {**values, "report": "false"}) for name, values in {**ROWS, **RISING}.items()}),
]

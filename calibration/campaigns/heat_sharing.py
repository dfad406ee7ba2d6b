"""Friction heat shared equally or by effusivity between tool and rock: exact faces of two bodies, and a short cut.

    python3 -m calibration.campaigns.heat_sharing DIR

Writes heat_sharing.md into DIR. The two cuts take a minute or two; finished runs are kept.
"""
import math

from calibration import command, generated
from calibration.campaigns.runs import Runs
from rockwear.kernels.analytic import sliding_half_spaces
from rockwear.kernels.conduction import effusivity, effusivity_share
from rockwear.model.materials import SANDSTONE, STEEL

SHARINGS = "effusivity", "equal"
EFFUSIVITIES = [effusivity(m.conductivity, m.density, m.specific_heat) for m in (STEEL, SANDSTONE)]
CONDUCTANCES = {"none": 0.0, "1500 W/m²K": 1.5e3, "15000 W/m²K": 1.5e4, "10⁶ W/m²K": 1e6}
TIMES = {"5 ms": 5e-3, "0.65 s": 0.65, "60 s": 60.0}
CUT = dict(rock="interlocked_sandstone", heat="true", wear_acceleration=0, cut_length=0.012, ramp_length=2e-3,
           window_behind=0.02, window_ahead=0.04, window_height=0.03, report="false", snapshot_period=1)


def share(sharing):
    """Part of the friction heat that the tool takes up."""
    return 0.5 if sharing == "equal" else effusivity_share(*EFFUSIVITIES)


def faces():
    """Rows of the rise of each face under equal sharing over that under sharing by effusivity, equal for both."""
    for name, conductance in CONDUCTANCES.items():
        cells = []
        for seconds in TIMES.values():
            even, own = (sliding_half_spaces(seconds, flux=1.0, share=share(s), effusivities=EFFUSIVITIES,
                                             conductance=conductance) for s in ("equal", "effusivity"))
            tool, rock = even / own
            cells.append(f"{tool:.2f} and {rock:.2f}")
        yield [name, *cells]


def rises(run):
    """K: of the hottest and the mean node of the tool, and of the hottest rock particle, at the end of a run."""
    temperature = run.snapshot(-1)["temperature"] - run.parameter("tool_temperature")
    rock = len(run.model["rock_radii"])
    return temperature[rock:].max(), temperature[rock:].mean(), temperature[:rock].max()


def cuts(folder):
    """{sharing: RunFolder} of one cut without wear, whose forces are the same whatever the heat does."""
    with Runs(folder, at_once=1, keep=True) as runs:
        jobs = {sharing: runs.start(sharing, "yade_scripts/steady_cut.py", heat_sharing=sharing, **CUT)
                for sharing in SHARINGS}
        return {sharing: job.result() for sharing, job in jobs.items()}


def tables(found):
    """All tables, as lines of Markdown."""
    by_effusivity, even = (rises(found[sharing]) for sharing in SHARINGS)
    work = found["equal"].summary["balances"]["friction"]["tool"]
    part = share("effusivity")
    hot = sliding_half_spaces(1.0, flux=1e6, share=part, effusivities=EFFUSIVITIES, conductance=0.0)[0]
    return ["## Two bodies that rub on each other", "",
            f"Steel on sandstone, effusivities {EFFUSIVITIES[0]:.0f} and {EFFUSIVITIES[1]:.0f} W s½/m²K: the steel "
            f"takes {100 * part:.1f} % of the friction heat, and both faces rise by {hot:.1f} K √(t/s) at 1 MW/m². "
            "Exact rise of the faces of tool and rock under equal sharing, over that, for a conductance of the "
            "contact:", "", *generated.table(["contact", *TIMES], faces()),
            "## A short cut", "",
            f"`steady_cut.py`, {1e3 * CUT['cut_length']:g} mm, no wear, {work:.3g} J/m of friction at the tool; K "
            "above the start.", "",
            *generated.table(["sharing", "hottest of the tool", "mean of the tool", "hottest of the rock"],
                             [[name, *(f"{rise:.3g}" for rise in values)] for name, values in (
                                 ("effusivity", by_effusivity), ("equal", even),
                                 ("equal over effusivity", [a / b if b else math.nan for a, b in zip(
                                     even, by_effusivity)]))])]


def main(folder):
    """Both cuts, and the page."""
    folder.mkdir(parents=True, exist_ok=True)
    print(generated.write_page(folder / "heat_sharing.md", tables(cuts(folder))))


if __name__ == "__main__":
    main(command.folder(__spec__.name, "out/heat_sharing"))

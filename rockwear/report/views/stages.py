"""Forces, wear and temperature stage by stage."""
import math

import numpy as np

from rockwear.report.instants import stage_name, turns
from rockwear.report.page import Section, percent, quantity, table


def stages(run):
    """Section of forces, wear and temperature by stage."""
    stage = run.column("stage")
    if "cutting_force" not in run.columns or not np.isfinite(stage).any() or turns(run):
        return None
    unit = run.units["cutting_force"]
    columns = [("mean cutting force", lambda k: quantity(mean_at_work(run, "cutting_force", k), unit)),
               ("peak", lambda k: quantity(run.over_stage("cutting_force", np.max, k), unit)),
               ("mean thrust force", lambda k: quantity(mean_at_work(run, "thrust_force", k), unit)),
               ("mass lost so far", lambda k: percent(lost(run, k), 1.0))]
    if "tool_temperature_max" in run.columns:
        columns.append(("hottest tool", lambda k: quantity(run.over_stage("tool_temperature_max", np.max, k), "K")))
    rows = [(stage_name(run, k), *(cell(k) for _, cell in columns))
            for k in np.unique(stage[np.isfinite(stage)]).astype(int)]
    return Section("Stage by stage", "", [table(rows, ("", *(header for header, _ in columns)))])


def lost(run, stage):
    """Part of the tool's mass that is lost by the end of a stage. In a run that ended before its time the last wear
    comes after the last row of the record."""
    at_end = stage == run.column("stage")[-1] and math.isfinite(run.result("mass_lost"))
    return run.result("mass_lost") if at_end else run.over_stage("mass_lost", np.max, stage)


def mean_at_work(run, name, stage):
    """Mean of a force over the working time of a stage: without the time in which the tool comes to the rock."""
    rows = run.column("stage") == stage
    worked = np.diff(run.column("working_time"), prepend=0.0)[rows].sum()
    return run.mean_over(name, rows, worked if math.isfinite(worked) else None)

"""When: the stages of a run by name, its times as shown, and the snapshots that are worth showing."""
import numpy as np

from rockwear.report.published import COOLING_TIMES, CUT_TIMES

LONG = 0.1
"""Runs of so many seconds and more are shown in s, shorter ones in ms."""


def turns(run):
    """True for a tool that cuts and cools in turns: odd stages cut, even ones cool."""
    return "own_path" in run.model


def clock(run):
    """(factor, unit) in which the times of this run are shown."""
    time = run.column("time")
    last = max(time[np.isfinite(time)].max(initial=0.0), run.times.max(initial=0.0))
    return (1.0, "s") if last >= LONG else (1e3, "ms")


def stage_name(run, stage):
    """What a stage is called."""
    names = run.model.get("stage_names", ())
    if stage < len(names):
        return str(names[stage])
    if turns(run):
        return (f"cut {(stage + 1) // 2}" if stage % 2 else f"cooling {stage // 2}") if stage else "approach"
    return f"cycle {stage}" if stage else "start-up"


def stage_of(run, k):
    """Stage of a snapshot; the one taken after the run belongs to the last recorded stage."""
    recorded = run.column("stage")
    last = np.nanmax(recorded) if np.isfinite(recorded).any() else run.stages[k]
    return int(min(run.stages[k], last))


def moment(run, k):
    """The stage and the time of a snapshot, in words."""
    factor, unit = clock(run)
    return f"{stage_name(run, stage_of(run, k))}, {factor * run.times[k]:.{2 if unit == 'ms' else 3}f} {unit}"


def cutting(run):
    """(rows,) bool: records of the stages in which the tool cuts, all of them where nothing is known of it."""
    stage = run.column("stage")
    if turns(run):
        return stage % 2 == 1
    if "stage_names" in run.model:
        return stage == len(run.model["stage_names"]) - 1
    return np.ones(len(stage), bool)


def nearest(run, stage, seconds):
    """{seconds into the stage: snapshot nearest to it}, each snapshot once."""
    found = np.flatnonzero(run.stages == stage)
    if not len(found):
        return {}
    begin = run.times[run.stages < stage].max(initial=0.0)
    chosen = [int(found[np.argmin(abs(run.times[found] - begin - s))]) for s in seconds]
    return {float(run.times[k] - begin): k for k in dict.fromkeys(chosen)}


def first_cut(run):
    """{label: snapshot} in the first cut of a run in turns."""
    return {f"{seconds:.2f} s of cutting": k for seconds, k in nearest(run, 1, CUT_TIMES).items()}


def first_cooling(run):
    """{label: snapshot} in the first cooling of a run in turns."""
    return {f"{seconds:.2f} s after the cut": k for seconds, k in nearest(run, 2, COOLING_TIMES).items()}


def course(run):
    """{label: snapshot}, up to six: the course of the first stage and of the last; of the first cut where there are
    turns."""
    if turns(run):
        return first_cut(run)
    stages = np.array([stage_of(run, k) for k in range(len(run.times))])
    first, last = np.flatnonzero(stages == stages[0]), np.flatnonzero(stages == stages[-1])
    shown = spread(first, 7)[-6:] if stages[0] == stages[-1] else spread(first, 4)[-3:] + spread(last, 4)[-3:]
    return {moment(run, k): k for k in shown}


def course_in_space(run, most=4):
    """{label: snapshot} of the last two stages, in which the tool comes to the rock and cuts it."""
    ends = run.stage_ends()
    before = sorted(ends)[:-2]
    begin = ends[before[-1]] if before else 0
    return {moment(run, k): k for k in spread(range(begin, len(run.times)), most)}


def worn(run, most):
    """{label: snapshot} to show wear at: the ends of the stages, of the cuts alone where there are turns, or of equal
    spans of a single stage."""
    ends = {stage_of(run, k): k for k in run.stage_ends().values()}
    if turns(run):
        ends = {stage: k for stage, k in ends.items() if stage % 2}
    if len(ends) > 1 or (turns(run) and ends):
        return {f"after {stage_name(run, stage)}": k for stage, k in spread(ends.items(), most)}
    return {f"after {moment(run, k).split(', ')[-1]}": k for k in spread(range(len(run.times)), most + 1)[-most:]}


def spread(items, most):
    """At most so many of the items, evenly spread, the first and the last among them."""
    items = list(items)
    return [items[k] for k in sorted({round(x) for x in np.linspace(0, len(items) - 1, min(most, len(items)))})]

"""The table of what engines cost in a steady cut, from made-up runs."""
from calibration.benchmarks import steady_cost

NAMES = [*steady_cost.ERRORS, "residual", "tool_work"]
EXACT = {**dict.fromkeys(NAMES, 20.0), "tool_work": 200.0}
FOUND = {"overhead": 0.083, "step": 2e-3, "discs": 10, "bonds": 20, "steps": 30, "sampled": 40, "distribution": 0.002,
         "turns": {"alive": [1.2], "dead": [1.0]},
         "critical_steps": {"intact": 1.01234, "under the tool": 0.95},
         "seconds": {"bonds": 3.0, "tool_contact": 1.0, "heat": 0.001}, "exact": EXACT,
         "found": {**EXACT, "rock_friction": 20.4, "residual": 1.0, "wear": 19.9}}


def test_errors_are_relative_and_over_the_work_of_the_tool():
    text = "\n".join(steady_cost.table(FOUND))
    assert "all Python costs 8.3 % of YADE's own step of 2.00 ms" in text
    assert "bonds 75 %, tool contact 25 %." in text
    assert "| friction work in the rock | +2.00 % | +0.20 % |" in text
    assert "| wear | -0.50 % | – |" in text
    assert "after 30 steps is 1.012 of that of untouched rock, that of a disc under the tool 0.950." in text
    assert "differs by 0.20 %" in text and "+0.50 % of the tool's work with the defaults and +10.00 %" in text


def test_what_engines_cost_yade_itself_is_of_each_turn():
    found = {"alive": [1.2e-3, 3e-3, 1.3e-3], "dead": [1e-3, 2e-3, 1e-3]}
    assert ("In 3 turns of some steps with the engines and without them YADE's own step takes 30.0 % longer with them "
            "(half of the turns 25.0 to 40.0)") in steady_cost.in_turns(found)

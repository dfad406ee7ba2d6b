"""Every colour of figures and pages, once, named by what it means."""
import numpy as np
from matplotlib import colormaps
from matplotlib.colors import LinearSegmentedColormap


def _scale(name, *colours):
    return LinearSegmentedColormap.from_list(name, colours)


# What is seen: rock, tool, cracks.
ROCK, ROCK_EDGE, FIXED = "#e2d4b4", "#8d7d58", "#9a9a92"
CRACK, REMOVED, REMOVED_EDGE = "#cc1414", "#f9dcdc", "#e08a8a"
TOOL, TOOL_SURFACE, TOOL_INSIDE, TOOL_UNWORN, TOOL_NEW = "#7d868c", "#2f3a40", "#c3c9cd", "#dfe3e6", "#eef0f1"
PARTICLE_EDGE, FACET_EDGE, HEAT_EDGE = "#777777", "#00000030", "#b5b5ac"
PATH, PATH_BEFORE = CRACK, "#2c6e91"

# Quantities in colour, from little to much.
DAMAGE = _scale("damage", ROCK, "#8f5a24")
CHIP = _scale("chip", "#c9dfee", "#3b7fb0")
TEMPERATURE = _scale("temperature", "#e9e9e4", "#fdd873", "#f58a3c", "#c8252c", "#54093a")
WEAR = _scale("wear", "#d9dde0", "#fdd873", "#f58a3c", "#c8252c", "#54093a")
DENSITY = _scale("density", "#54093a", "#c8252c", "#f58a3c", "#fdd873", "#e9e9e4")
TRAVEL, DISPLACEMENT, DIMENSIONLESS = colormaps["YlOrBr"], colormaps["viridis"], colormaps["inferno"]

# Lines of quantities that stand for the same everywhere.
CUTTING, THRUST, SIDEWAYS = "#b5651d", "#2c6e91", "#8a8a8a"
WORK, MOTION, FRICTION, BREAKING, CRUSHING = "#444444", "#b5651d", "#2c6e91", CRACK, "#7a6a9c"
TENSILE, SHEAR = CRACK, "#2c6e91"
WORN, MASS_LOST = CRACK, "#444444"
TOOL_HEAT, ROCK_HEAT, HOTTEST_PART, MEAN_HEAT, COOLED = CRACK, "#b5651d", "#e08a1e", "#444444", "#2c6e91"
STRESS, STRESS_OF_TRAVEL, LATERAL, CONFINEMENT = "black", "#999999", "#3b7fb0", "#b5651d"
SIMULATED, EXACT, DESCENT = "black", "#c8a15a", "#3b7fb0"
SPEEDS = ("#c8252c", "#e08a1e", "#2c6e91", "#5b8c3a", "#6b4c9a")
LARGEST, MEAN, PUBLISHED = CRACK, "black", "#3b7fb0"
ERROR, EVENTS, TRUSTED = "#2c6e91", "#b5651d", "#e4efe0"
POINTS = "#2a4d69"
OTHER_LINES = ("#2c6e91", "#b5651d", "#cc1414", "#5b8c3a", "#6b4c9a", "#8a8a8a", "#c8a15a")
PACKINGS = {"random": "#b0522a", "square": "#3b7fb0", "triangular": "#4a8a3c"}

# Bars, backgrounds and lines that guide the eye.
BAR, BAR_ERROR, BAR_RESIDUAL = "#b08d57", "#444444", "#cc2222"
STAGE, STAGE_BETWEEN, CUTTING_TIME = "#f3ede1", "white", "#f3e3c4"
GUIDE, OUTLINE, LABEL_BACK, FIGURE, REMARK = "#999999", "black", "white", "white", "#666666"

# The page.
PAGE = {"text": "#222", "back": "#fff", "rule": "#c8a15a", "faint": "#555", "line": "#e4ddd0", "panel": "#f6f2ea",
        "warning": "#fbe9e7", "warning_edge": CRACK}


def sequence(count):
    """(count, 4) colours of instants or stages, from first to last."""
    return colormaps["plasma"](np.linspace(0, 0.85, count))


def greys(count):
    """(count, 3) greys, from light to black, of instants or stages."""
    return np.tile(np.linspace(0.75, 0.0, count)[:, None], 3)

"""Sizes of discs, window and tooth for a cut of a given depth and resolution."""
from rockwear.kernels.checks import positive

DEPTHS = dict(window_behind=2.4, window_ahead=5.0, window_height=4.0, fine_depth=1.6, tooth_height=2.4,
              tooth_width=1.6)
"""Lengths over the depth of cut: chips are about a depth long, and rock breaks half a depth below the cut."""
RADII = dict(radius_min=0.8, radius_max=1.2, tool_radius_min=0.64, tool_radius_max=0.768)
"""Radii, times the discs in the depth of cut, over half of it."""
LARGEST, MOST_GRADING = 0.1875, 8.0
"""Largest radius at the bottom of the window over the depth of cut; largest grading factor of a packing."""


def cut_sizes(depth, discs):
    """{name of a parameter of the steady cut: m; grading_factor: -} for `discs` rock discs in a depth of cut (m).

    Rock discs have a mean diameter of depth / discs, those of the tool's surface 0.7 of it. Ours; how a cut depends on
    it is in calibration/results/steady_cut.md. Raises ParameterError.
    """
    depth, discs = positive("depth_of_cut", depth, "m"), positive("discs_per_depth", discs, "")
    radii = {name: 0.5 * depth * part / discs for name, part in RADII.items()}
    grading = min(max(1.0, LARGEST * depth / radii["radius_max"]), MOST_GRADING)
    return {**radii, **{name: part * depth for name, part in DEPTHS.items()}, "grading_factor": grading}

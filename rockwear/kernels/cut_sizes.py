"""Sizes of discs, window and tooth for a cut of a given depth and resolution."""
import math

from rockwear.kernels.checks import not_negative, positive

DEPTHS = dict(window_behind=2.4, window_ahead=8.0, window_height=6.0, fine_depth=2.4, tooth_height=2.4,
              tooth_width=1.6, ramp_length=1.0)
"""Lengths over the depth of cut. Rock breaks half a depth to a depth below the cut, and cracks go a depth further: in
a window of four depths they reached its bottom, and in rock that is fine for 1.6 depths alone they ran along the border
to the coarse rock. Chips are one to three depths long; with five depths ahead one of them reached the end of the window
now and then, and the next seam was left unbonded."""
RADII = dict(radius_min=0.8, radius_max=1.2, tool_radius_min=0.64, tool_radius_max=0.768)
"""Radii, times the discs in the depth of cut, over half of it."""
LARGEST, MOST_GRADING = 0.1875, 8.0
"""Largest radius at the bottom of the window over the depth of cut; largest grading factor of a packing."""
ROWS = 100
"""Rows of the record while the tool goes on by a depth of cut: twice as many as steady_record.RESOLUTION asks for."""


def cut_sizes(depth, discs, *, velocity, blunt=0.0, rake=0.0):
    """{name of a parameter of the steady cut: its value} for `discs` rock discs in a depth of cut.

    Rock discs have a mean diameter of depth / discs, those of the tool's surface 0.7 of it. depth: m; velocity: m/s;
    blunt: m that a round tip or a wear flat makes the tooth wider, and the window behind it longer where they do not
    fit in with a depth to spare; rake: rad, below 0 the tooth is wider where its back would not lie half a depth behind
    the tip. Lengths in m, record_period in s, grading_factor without unit. Ours; how a cut depends on it is in
    calibration/results/steady_cut.md. Raises ParameterError.
    """
    depth, discs = positive("depth_of_cut", depth, "m"), positive("discs_per_depth", discs, "")
    velocity, blunt = positive("velocity", velocity, "m/s"), not_negative("blunt", blunt, "m")
    radii = {name: 0.5 * depth * part / discs for name, part in RADII.items()}
    grading = min(max(1.0, LARGEST * depth / radii["radius_max"]), MOST_GRADING)
    lengths = {name: part * depth for name, part in DEPTHS.items()}
    least = 0.5 * depth + math.tan(max(0.0, -rake)) * lengths["tooth_height"]
    lengths["tooth_width"] = max(lengths["tooth_width"], least) + blunt
    lengths["window_behind"] = max(lengths["window_behind"], depth + blunt)
    return {**radii, **lengths, "grading_factor": grading, "record_period": depth / (ROWS * velocity)}

"""The cut of `make run`, whose engines are timed."""

CUT = dict(rock="crushing_sandstone", discs_per_depth=8, depth_of_cut=2e-3, tip_radius=2e-4, velocity=8.0,
           cut_length=0.06, rake=-5.0, clearance=5.0, tool_kn=5e9, tool_kt=5e9, contact_damping=0.1,
           time_step_fraction=0.95, heat=True, wear_acceleration=500)
"""With the defaults of its script."""
BEGIN = 0.006
"""m of way before anything is timed."""

"""Instants and numbers of published figures that runs are shown beside."""
CUT_TIMES = 0.01, 0.2, 0.4, 0.65
"""Instants of the first turn's cut in [Rojek 2014, figs. 12, 13, 16], s."""
COOLING_TIMES = 0.03, 0.13, 0.83, 1.35
"""Instants of the first turn's cooling in [Rojek 2014, fig. 14], s after the cut (0.68, 0.78, 1.48 and 2.00 s)."""
WORN_DEPTH = 0.14e-3
"""m, largest worn depth of [Rojek 2003, section 13.3] (model II), of a tool that keeps its particles."""

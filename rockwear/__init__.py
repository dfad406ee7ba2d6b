"""rockwear: how a rock-cutting tool heats up, wears and changes its shape, on the YADE discrete element engine.

References, and the keys that docstrings, --help and reports use for them:

[Rojek 2003]       J. Rojek, E. Oñate, F. Zárate, C.A. Recarey: Discrete element modelling of rock cutting processes
                   interaction with evaluation of tool wear. Monograph CIMNE M87, Barcelona, 2003.
[Rojek 2014]       J. Rojek: Discrete element thermomechanical modelling of rock cutting with valuation of tool wear.
                   Computational Particle Mechanics 1 (2014) 71-84.
[Rocky]            Rocky DEM, technical manual, section 2.5: wear model (wear of triangulated boundaries).
[Bahaaddini 2018]  M. Bahaaddini, M. Rahimi: Distinct element modelling of the mechanical behaviour of intact rocks
                   using Voronoi tessellation model. International Journal of Mining and Geo-Engineering, 2018.
"""
__version__ = "0.31.0"

"""Remeshing: crowded facets are moved to where facets are missing, and the shape stays."""
import numpy as np
import pytest

from rockwear.kernels.boundary import altitudes, check_boundary, crossings, distance, refine, segments
from rockwear.kernels.checks import ParameterError
from rockwear.kernels.remeshing import CROWDED, Mesh
from tests.kernels.shapes import TOOTH, cube, exact_volume


def test_a_tool_without_a_free_facet_is_refused():
    vertices, facets = cube()
    with pytest.raises(ParameterError, match="at least one free"):
        Mesh(vertices=vertices, facets=facets, fixed=np.ones(len(facets), bool))


@pytest.mark.parametrize("make, off", [(lambda: refine(*segments(TOOTH), 1e-3), 1e-8), (cube, 5e-5)])
def test_crowded_facets_go_to_where_facets_are_missing_and_nothing_else_changes(make, off):
    mesh = Mesh(vertices=make()[0], facets=make()[1])
    first, facets, chance = mesh.vertices.copy(), mesh.facets.copy(), np.random.default_rng(2)
    mesh.pending = chance.random(len(facets))
    # Vertices inside plane faces move nearly to a neighbour: the shape is the same, the facets are crowded.
    for vertex in chance.permutation(len(first))[:len(first) // 4]:
        if mesh._sharpness(vertex)[-1] < 1e-12:
            to = chance.choice(mesh.around[mesh.around[:, 0] == vertex, 1])
            mesh.vertices[vertex] += 0.9 * (mesh.vertices[to] - mesh.vertices[vertex])
            if (altitudes(mesh.vertices, facets) < 0.02 * mesh.size).any() or len(crossings(mesh.vertices, facets)):
                mesh.vertices[vertex] = first[vertex]
    crowded = (altitudes(mesh.vertices, facets) < CROWDED * mesh.size).sum()
    before = exact_volume(mesh.vertices, mesh.facets)
    assert crowded > 10 and mesh.even_out()
    while mesh.even_out():
        pass
    assert (altitudes(mesh.vertices, mesh.facets) < CROWDED * mesh.size).sum() < 0.2 * crowded
    check_boundary(mesh.vertices, mesh.facets)
    assert abs(float(exact_volume(mesh.vertices, mesh.facets) - before)) < 1e-14 * float(before)
    assert max(distance(mesh.vertices, first, facets).max(), distance(first, mesh.vertices, mesh.facets).max()) < off
    assert mesh.pending.sum() == pytest.approx(np.random.default_rng(2).random(len(facets)).sum(), rel=1e-12)
    # `place` is the first facet on whose part of the surface a facet lies.
    middle = mesh.vertices[mesh.facets].mean(axis=1)
    assert np.linalg.norm(middle - first[facets[mesh.place]].mean(axis=1), axis=1).max() < 0.02

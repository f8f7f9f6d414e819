"""Paths stored end to end, read back against scipy's piecewise polynomials."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import PPoly

from physics._jit import njit
from physics.paths.depth_path import RELIEF_LEVELS, DepthPath, path_at, paths_of


@njit
def read(paths, path, arcs, found):
    for k in range(arcs.size):
        found[k, 0], found[k, 1] = path_at(paths, path, arcs[k])


def drawn(rng, pieces, narrow):
    """A path with jumps in depth and slope at every break; some pieces are `narrow` times as wide as others."""
    breaks = np.cumsum(np.where(rng.random(pieces + 1) < 0.5, 1.0, narrow) * rng.uniform(0.5, 1.5, pieces + 1))
    cells = rng.integers(1, 6, pieces)
    return DepthPath(breaks, cells, rng.normal(size=(cells.sum(), 4)), 0.0, 1.0, False, False, np.zeros(RELIEF_LEVELS))


def as_polynomial(path):
    parts = zip(path.breaks[:-1], path.breaks[1:], path.cells, strict=True)
    edges = np.concatenate([*(np.linspace(a, b, n + 1)[:-1] for a, b, n in parts), path.breaks[-1:]])
    return PPoly((path.cubics / np.diff(edges)[:, None] ** [3, 2, 1, 0]).T, edges)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(seed=st.integers(0, 2**32 - 1), pieces=st.lists(st.integers(1, 60), min_size=1, max_size=3))
def test_every_path_is_found_among_several(seed, pieces):
    rng = np.random.default_rng(seed)
    paths = [drawn(rng, count, 10.0 ** rng.uniform(-4.0, 0.0)) for count in pieces]
    stored = paths_of(paths)
    for index, path in enumerate(paths):
        polynomial = as_polynomial(path)
        arcs = rng.uniform(path.breaks[0], path.breaks[-1], 200)
        # Not so near an edge of a cell that rounding decides which of two cubics holds.
        beside = np.abs(arcs[:, None] - polynomial.x).min(axis=1) > 1e-9
        found = np.empty((arcs.size, 2))
        read(stored, index, arcs, found)
        for column, order in ((0, 0), (1, 1)):
            exact = polynomial(arcs[beside], nu=order)
            assert np.allclose(found[beside, column], exact, rtol=1e-6, atol=1e-6 * np.abs(exact).max(initial=1.0))


def test_an_edge_belongs_to_the_piece_before_it():
    breaks = np.array([0.0, 1.0, 1.5, 4.0])
    levels = np.array([[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 2.0], [0.0, 0.0, 0.0, 3.0]])
    path = DepthPath(breaks, np.ones(3, dtype=np.int64), levels, 0.0, 3.0, False, False, np.zeros(RELIEF_LEVELS))
    assert path.depth(np.array([0.0, 1.0, 1.0 + 1e-9, 1.5, 1.5 + 1e-9, 4.0])).tolist() == [1.0, 1.0, 2.0, 2.0, 3.0, 3.0]
    assert path.depth(np.array([-1e-9, 4.0 + 1e-9])).tolist() == [0.0, 0.0]

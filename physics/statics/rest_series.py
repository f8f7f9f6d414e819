"""Where the shaft rests at evenly spaced instants, and how stiff it is held, solved only where neighbours do not tell.

Between the instants at which a ball takes or loses its load or crosses an edge of its path, stiffness is smooth. So it
is solved at coarse instants, and the gaps are halved again and again: an instant around which nothing happens and at
which the polynomials through its four and its six neighbours agree is interpolated, every other one is solved
(interpolatory subdivision: Deslauriers, Dubuc (1989), Symmetric iterative interpolation processes).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from physics._jit import njit_inline, njit_inner, njit_lean
from physics.angular_speed import in_hertz
from physics.arrays import Array
from physics.assembly import assemble
from physics.contact.contact_set import mark_of
from physics.contact.forces import FORCE, Contacts
from physics.contact.track import ANGLE, CAGE, ENTRY, LEAVE, ROUGH, SIGN, SPEED, cage_at
from physics.motion import MotionModel, motion_model
from physics.paths.depth_path import BREAK, span_of
from physics.paths.profile import is_rough
from physics.scene import Scene
from physics.statics.load_distribution import require_carried
from physics.statics.successive_rest import expected, rest_at

# Polynomials of four and six neighbours may differ by this share of kyy. Measured in tests/physics: the trace is then
# within a tenth of 1e-4 of kyy (RMS) of the one solved everywhere. Where both agree by chance, single instants are off
# by some 1e-4.
AGREEMENT = 1e-5
# Share of the load that may be left unbalanced where it is solved.
TOLERANCE = 1e-7
COARSEST_STRIDE = 64
FEWEST_NODES_PER_PASS = 64.0
FEWEST_NODES_PER_WAVE = 16.0
# Coefficients of the six neighbours (k ± 1, ± 3, ± 5) for the value in the middle, and of how far the four miss it.
NEAR, MIDDLE, FAR = 150.0 / 256.0, -25.0 / 256.0, 3.0 / 256.0
MISS_NEAR, MISS_MIDDLE, MISS_FAR = 6.0 / 256.0, -9.0 / 256.0, 3.0 / 256.0
# Columns of a series: the shaft's place (m), stiffness (N/m), and a number that changes when something happens.
PLACE_X, PLACE_Y, XX, YY, XY, MARK = range(6)
COLUMNS = 6
# What an edge that was crossed adds to the mark of the pressed balls. No multiple of it up to the 200 000th is what one
# or two balls change there.
CROSSING_MARK = 100003.0


class RestSeries(NamedTuple):
    """Where the shaft rests at T instants and at `behind` more that only served to interpolate these.

    `rows` (T + behind, 6) have the columns above, `missed` (3,) is the mean square of what the polynomials of the
    interpolated instants differ by, over all instants, (N/m)², and `solved` the share of the instants that was solved.
    """

    rows: Array
    missed: Array
    solved: float


def rest_series(scene: Scene, step: float, count: int, stride: int, tolerance: float = TOLERANCE) -> RestSeries:
    """The places at the `count` instants k · `step` (s), each at its instant's load and angles, solved to a `tolerance`
    (share of the load left unbalanced) at every `stride`-th (a power of two) and between these where neighbours do not
    tell.

    Raises SimulationFailed where no position of the shaft carries the load.
    """
    nodes = -(-(count - 1) // stride) * stride + 1
    time: Array = np.arange(nodes, dtype=np.float64) * step
    rows, missed = np.zeros((nodes, COLUMNS)), np.zeros(4)
    lost = _fill(assemble(scene), motion_model(scene), time, stride, tolerance, rows, missed)
    # The instants behind the last one asked for serve interpolation only.
    require_carried(scene, time[:count], lost)
    return RestSeries(rows, missed[:3] / nodes, 1.0 - missed[3] / nodes)


def coarsest_stride(scene: Scene, step: float) -> int:
    """How many steps (s) apart the coarsest instants lie: a power of two that every ball pass and wave still shows in.

    1 where a ball is always on a rough surface.
    """
    if any(spall.extent >= scene.rig.bearing.spacing and is_rough(spall, scene.rig.bearing) for spall in scene.spalls):
        return 1
    bearing, turn = scene.rig.bearing, in_hertz(scene.operation.shaft_speed)
    needed = FEWEST_NODES_PER_PASS * max(bearing.bpfo, bearing.bpfi) * turn
    for wave in scene.imperfections.waviness:
        needed = max(needed, FEWEST_NODES_PER_WAVE * wave.order * turn)
    return int(2.0 ** math.floor(math.log2(min(max(1.0 / (step * needed), 1.0), COARSEST_STRIDE))))


@njit_lean
def _fill(
    contacts: Contacts, motion: MotionModel, time: Array, stride: int, tolerance: float, series: Array, missed: Array
) -> int:
    """Fill `series` (T, 6), T − 1 a multiple of `stride`; add to `missed` (4,) squared differences and their number.

    Returns the first of the instants solved at which no position carries the load, or T.
    """
    lost, between = time.size, stride > 1
    for k in range(0, time.size, stride):
        x, y = expected(series, k, stride)
        lost = lost if _solve(contacts, motion, time[k], tolerance, series[k], x, y, between) else min(lost, k)
    half = stride // 2
    while half > 0:
        for k in range(half, time.size, 2 * half):
            if k < 5 * half or k + 5 * half >= time.size:
                x = 0.5 * (series[k - half, PLACE_X] + series[k + half, PLACE_X])
                y = 0.5 * (series[k - half, PLACE_Y] + series[k + half, PLACE_Y])
                lost = lost if _solve(contacts, motion, time[k], tolerance, series[k], x, y, between) else min(lost, k)
            elif not _interpolate(series, k, half, missed):
                x, y = _between(series, k, half, PLACE_X), _between(series, k, half, PLACE_Y)
                lost = lost if _solve(contacts, motion, time[k], tolerance, series[k], x, y, between) else min(lost, k)
        half //= 2
    return lost


@njit_inner
def _solve(
    contacts: Contacts,
    motion: MotionModel,
    time: float,
    tolerance: float,
    row: Array,
    x: float,
    y: float,
    between: bool,
) -> bool:
    """The `row` (6,) at `time` (s), looked for from the place (x, y), m; whether a position carries the load there.

    If instants `between` may be interpolated, its mark says more than which balls are pressed.
    """
    row[PLACE_X], row[PLACE_Y], sums, carried = rest_at(contacts, motion, time, x, y, tolerance)
    row[XX], row[YY], row[XY] = sums.xx, sums.yy, sums.xy
    row[MARK] = _mark(contacts, time) if between else mark_of(contacts.balls, FORCE)
    return carried


@njit_inner
def _interpolate(series: Array, k: int, half: int, missed: Array) -> bool:
    """Fill row `k` from its neighbours and return True, unless something happens between them or they disagree."""
    mark = series[k - half, MARK]
    same = mark == series[k + half, MARK] and mark == series[k - 3 * half, MARK] and mark == series[k + 3 * half, MARK]
    if not same:
        return False
    allowed = AGREEMENT * series[k - half, YY]
    xx, yy, xy = _miss(series, k, half, XX), _miss(series, k, half, YY), _miss(series, k, half, XY)
    if not max(abs(xx), abs(yy), abs(xy)) <= allowed:
        return False
    for column in range(XY + 1):
        series[k, column] = _between(series, k, half, column)
    series[k, MARK] = series[k - half, MARK]
    missed[0] += xx * xx
    missed[1] += yy * yy
    missed[2] += xy * xy
    missed[3] += 1.0
    return True


@njit_inner
def _between(series: Array, k: int, half: int, column: int) -> float:
    """The polynomial through the six neighbours of row `k`."""
    return _weighed(series, k, half, column, (NEAR, MIDDLE, FAR))


@njit_inner
def _miss(series: Array, k: int, half: int, column: int) -> float:
    """How far the polynomial through the six neighbours of row `k` lies from the one through the nearer four."""
    return _weighed(series, k, half, column, (MISS_NEAR, MISS_MIDDLE, MISS_FAR))


@njit_inline
def _weighed(series: Array, k: int, half: int, column: int, weights: tuple[float, float, float]) -> float:
    """Sum of the nearest, the next and the farthest pair of the six neighbours of row `k`, each times its weight."""
    near = series[k - half, column] + series[k + half, column]
    middle = series[k - 3 * half, column] + series[k + 3 * half, column]
    far = series[k - 5 * half, column] + series[k + 5 * half, column]
    return weights[0] * near + weights[1] * middle + weights[2] * far


@njit_inner
def _mark(contacts: Contacts, time: float) -> float:
    """A whole number that changes when a ball is pressed, is released or crosses an edge of its path.

    Not a number, and so equal to none, while a ball runs over a rough surface.
    """
    track, mark = contacts.track, mark_of(contacts.balls, FORCE)
    per_spacing = 1.0 / track.spacing
    for spall in range(track.spalls.shape[0]):
        angle, _ = cage_at(track, int(track.spalls[spall, CAGE]), time)
        ahead = track.spalls[spall, SIGN] * (angle - track.spalls[spall, ANGLE] - track.spalls[spall, SPEED] * time)
        entered = math.floor((ahead - track.spalls[spall, ENTRY]) * per_spacing)
        left = math.floor((ahead - track.spalls[spall, LEAVE]) * per_spacing)
        crossed = entered + left
        if track.spalls[spall, ROUGH] > 0.0:
            if entered > left:
                return math.nan
        else:
            first, behind = span_of(track.paths, spall)
            for edge in range(first + 1, behind - 1):
                crossed += math.floor((ahead - track.paths.pieces[edge, BREAK]) * per_spacing)
        mark += CROSSING_MARK * (spall + 1) * crossed
    return mark

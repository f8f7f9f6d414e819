"""How much shorter the time between the events is than the spall, from load, Hertz factor and geometry."""

from __future__ import annotations

from physics.bearing import Bearing
from physics.paths.held_ball import ball_of

# Compression at a spall over that in the direction of the load: mean cosine of the angle between them over spall
# centres within ±25 degrees (one standard deviation).
USUAL_SHARE_OF_PEAK = 0.91


def static_compression(bearing: Bearing, load: float) -> float:
    """Compression (m) of a ball at a spall near the middle of the load zone under a radial `load`, N [P14 Eq. 24]."""
    return USUAL_SHARE_OF_PEAK * bearing.compression(bearing.stribeck_peak_load(abs(load)))


def release_arc(bearing: Bearing, race: str, load: float) -> float:
    """Arc (rad) from a sharp edge to where the ball has dropped by its static compression and is released."""
    return ball_of(bearing, race).reach_from_edge(static_compression(bearing, load))


def arc_with_static_release(lag_arc: float, bearing: Bearing, race: str, load: float) -> float:
    """Arc of a spall (rad) from the `lag_arc` (rad) between its events under a radial `load`, N.

    The ball is released one release arc behind the entry edge and takes load again one before the exit edge, so the
    arc is that between the events plus twice the release arc.
    """
    return lag_arc + 2.0 * release_arc(bearing, race, load)

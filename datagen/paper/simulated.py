"""The simulated accelerations of the gearbox rig behind Figures 8 to 10: slip of 1 %, 1.4 s, ten seeds a condition."""

from __future__ import annotations

from functools import cache

from datagen.drawing.style import EXTENDED, HEALTHY, LINE, ORANGE
from datagen.paper.scenes import SEEDS, SHOWN_SEED, reference_extended_spall, scene, signal, wavy_extended_spall
from physics.arrays import Array
from physics.reference_scenes import gap_line_spall, line_spall
from physics.spall import Spall

CONDITIONS = {
    "healthy": (HEALTHY, "healthy"),
    "line": (LINE, "line spall 2°"),
    "extended": (EXTENDED, "extended spall 40°, long waves"),
    "reference": (ORANGE, "extended spall 40°, reference profile G2r"),
}
SAME_FOR_ALL = (
    "7 Hz, 346 N, slip of 1 % standard deviation with one ball pass of correlation time, 1.4 s at 65 536 Hz after 0.1 "
    "s of start, ten seeds of slip and profile (the pictures show one near their middle), spectra under a Hann window."
)


@cache
def simulated(condition: str, count: int = len(SEEDS)) -> tuple[Array, ...]:
    """Accelerations along y (T,) of a condition, one for each of `count` seeds, m/s²; "gap" is scene G1p."""
    return tuple(signal(scene("gearbox", *_spalls(condition, seed), slip_seed=seed)) for seed in range(count))


@cache
def shown(condition: str) -> Array:
    """The acceleration along y (T,) that the pictures show, m/s²."""
    return signal(scene("gearbox", *_spalls(condition, SHOWN_SEED), slip_seed=SHOWN_SEED))


def _spalls(condition: str, seed: int) -> tuple[Spall, ...]:
    if condition == "healthy":
        return ()
    if condition in ("line", "gap"):
        return ({"line": line_spall, "gap": gap_line_spall}[condition]("gearbox"),)
    return ({"extended": wavy_extended_spall, "reference": reference_extended_spall}[condition](seed),)

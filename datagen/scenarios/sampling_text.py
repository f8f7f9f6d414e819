"""Sampling in the JSON text of a scenario: the record's grid, the finer one it is simulated on, the filter between."""

from __future__ import annotations

from typing import Any

from datagen.scenarios.scenario import Scenario
from physics.response.oversampling import needed_multiple
from physics.response.resampling import HALF_LENGTH_SAMPLES, HALVED_SHARE, KAISER_BETA

LOWERING_RULE = (
    "simulated at the instants k / (oversampling rate_hz), k = 0 to samples oversampling + half_length - 1, the cage "
    "going on behind its last knot at the speed it has there; from a signal x at these instants the record takes y[m] "
    "= sum of h[n] x[m oversampling + n] over n = -half_length to half_length, x before its first value being that "
    "value; h[n] = g sinc(cutoff n) I0(kaiser_beta sqrt(1 - (n / half_length)^2)), sinc(v) = sin(pi v) / (pi v), I0 "
    "the modified Bessel function, g such that the sum of h is 1. Lowered so are the resonator's acceleration and the "
    "sum of the chain's modes; contact forces are samples"
)


def sampling_data(scenario: Scenario) -> dict[str, Any]:
    """The sampling as plain data; `lowering` is None where the simulation runs at the record's own rate, and
    `settle_s` is there only where a record does not begin at rest."""
    factor = needed_multiple(scenario.scene, scenario.rate, scenario.chain.fastest)
    settled = {"settle_s": scenario.settle} if scenario.settle > 0.0 else {}
    return settled | {
        "rate_hz": scenario.rate,
        "duration_s": scenario.duration,
        "samples": scenario.samples,
        "envelope_band_hz": list(scenario.envelope_band),
        "oversampling": factor,
        "lowering": None if factor == 1 else _lowering(factor),
    }


def _lowering(factor: int) -> dict[str, Any]:
    return {
        "half_length": HALF_LENGTH_SAMPLES * factor,
        "cutoff": HALVED_SHARE / factor,
        "kaiser_beta": KAISER_BETA,
        "rule": LOWERING_RULE,
    }

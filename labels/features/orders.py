"""Features of the vibration's own spectrum, as velocity orders, and of its cepstrum."""

from __future__ import annotations

import numpy as np
from scipy import fft

from labels.features.analysis import VIBRATION_ORDERS, Analysis
from labels.features.feature import Feature
from labels.features.speed import SHAFT_HARMONICS
from physics.arrays import Array
from physics.bearing import RACES

ORDERS = "ISO 13373-2:2016 (narrow-band spectra, orders); Petersen et al. 2014, section 6 (low harmonics of BPFO)"
CEPSTRUM = "Randall 2017, Mech. Syst. Signal Process. 97 (cepstrum analysis)"
LINE_ORDERS = 0.03
RAHMONICS = 2
# Shares of a rahmonic's place: within which its largest value lies, and between which the scatter round it is taken.
RAHMONIC_WITHIN, SCATTER_WITHIN = 0.006, (0.7, 1.3)
VELOCITY_HARMONICS = 6

ROWS = (
    Feature("turns", "ln", "ln of the number of turns of the shaft in the record.", ORDERS),
    Feature("shaft_evidence", "ln nat", "ln(1 + evidence of shaft harmonics, vibration and widest envelope).", ORDERS),
    Feature("outer_vibration", "ln nat", "ln(1 + evidence of BPFO 1 to 4 in the vibration itself).", ORDERS),
    Feature("inner_vibration", "ln nat", "ln(1 + evidence of BPFI 1 to 4 in the vibration itself).", ORDERS),
    Feature("race_vibration", "ln nat", "outer_vibration minus inner_vibration.", ORDERS),
    Feature("outer_velocity", "log10", "log10 of the share of velocity power at BPFO 1 to 6, up to their top.", ORDERS),
    Feature("inner_velocity", "log10", "log10 of the share of velocity power at BPFI 1 to 6, up to their top.", ORDERS),
    Feature("shaft_velocity", "log10", "log10 of the share of velocity power, to order 12, at orders 1 to 8.", ORDERS),
    Feature("outer_cepstrum", "ln", "ln(1 + height over scatter of the cepstrum at 1 and 2 BPFO periods).", CEPSTRUM),
    Feature("inner_cepstrum", "ln", "ln(1 + height over scatter of the cepstrum at 1 and 2 BPFI periods).", CEPSTRUM),
    Feature("shaft_cepstrum", "ln", "ln(1 + height over scatter of the cepstrum at 1 and 2 shaft periods).", CEPSTRUM),
)


def measure(analysis: Analysis) -> dict[str, float]:
    """Values of ROWS by name."""
    shaft = analysis.speed.shaft_hz
    outer, inner = (analysis.race_family(analysis.vibration, race) for race in RACES)
    lines = {
        "outer_vibration": float(np.log1p(outer.evidence[0])),
        "inner_vibration": float(np.log1p(inner.evidence[0])),
    }
    velocity = velocity_power(analysis)
    cepstrum = _cepstrum(analysis)
    return lines | {
        "turns": float(np.log(shaft * analysis.record.duration)),
        "shaft_evidence": float(np.log1p(analysis.speed.evidence)),
        "race_vibration": lines["outer_vibration"] - lines["inner_vibration"],
        "outer_velocity": _share(analysis, velocity, float(outer.fundamental[0]), VELOCITY_HARMONICS),
        "inner_velocity": _share(analysis, velocity, float(inner.fundamental[0]), VELOCITY_HARMONICS),
        "shaft_velocity": _share(analysis, velocity, shaft, SHAFT_HARMONICS, VIBRATION_ORDERS * shaft),
        "outer_cepstrum": rahmonics(analysis, cepstrum, float(outer.fundamental[0])),
        "inner_cepstrum": rahmonics(analysis, cepstrum, float(inner.fundamental[0])),
        "shaft_cepstrum": rahmonics(analysis, cepstrum, shaft),
    }


def velocity_power(analysis: Analysis) -> Array:
    """Power (F,) of the vibration as velocity at each component of its spectrum, up to a constant factor and as far as
    the shares need it; 0 where sensors drift."""
    # Shares are taken of what lies below these orders at most.
    highest = (VELOCITY_HARMONICS + 1.0) * max(analysis.given.bpfo, analysis.given.bpfi)
    count = int(max(highest, VIBRATION_ORDERS + 1.0) * analysis.given.shaft_hz / analysis.record.step) + 2
    power = np.abs(analysis.record.slow(count)) ** 2
    frequency = np.arange(power.size) * analysis.record.step
    return np.where(frequency > analysis.drift_hz, power / np.maximum(frequency, 1e-9) ** 2, 0.0)


def _share(analysis: Analysis, power: Array, fundamental: float, harmonics: int, top: float | None = None) -> float:
    """log10 of the share of `power` below `top` (Hz; half a spacing above the last line) that lies on the lines.

    In a few turns of the shaft its lines run into each other; what lies on two counts twice, and the share may pass 1.
    """
    step = analysis.record.step
    reach = max(1.5, LINE_ORDERS * analysis.speed.shaft_hz / step)
    last = min(power.size, int(((harmonics + 0.5) * fundamental if top is None else top) / step))
    cumulated = np.concatenate([[0.0], np.cumsum(power[:last])])
    centres = np.arange(1, harmonics + 1) * fundamental / step
    low = np.clip((centres - reach).astype(np.int64), 0, last)
    high = np.clip((centres + reach).astype(np.int64) + 1, 0, last)
    share = float((cumulated[high] - cumulated[low]).sum()) / max(float(cumulated[-1]), np.finfo(np.float64).tiny)
    return float(np.log10(max(share, 1e-6)))


def _cepstrum(analysis: Analysis) -> Array:
    """Real cepstrum of the flattened spectrum; quefrency n is n / (twice the bandwidth)."""
    level = np.log(np.abs(analysis.record.flat) ** 2 + 1e-3)
    level -= level.mean()
    return np.asarray(fft.irfft(level, fft.next_fast_len(2 * level.size, real=True)))


def rahmonics(analysis: Analysis, cepstrum: Array, frequency: float) -> float:
    """Height of the `cepstrum` (Q,) at one and two periods of a `frequency` (Hz): ln(1 + mean of the largest values
    near these rahmonics over the scatter around them)."""
    rate = analysis.record.step * cepstrum.size
    heights = []
    for k in range(1, RAHMONICS + 1):
        centre = k * rate / frequency
        reach = max(1, round(RAHMONIC_WITHIN * centre))
        first, last = (int(share * centre) for share in SCATTER_WITHIN)
        wide = slice(max(1, first), min(cepstrum.size // 2, last + 2))
        near = slice(max(1, int(centre) - reach), min(cepstrum.size // 2, int(centre) + reach + 2))
        if near.stop <= near.start:
            return 0.0
        scatter = 1.4826 * float(np.median(np.abs(cepstrum[wide]))) + 1e-12
        heights.append(float(cepstrum[near].max()) / scatter)
    return float(np.log1p(max(float(np.mean(heights)), 0.0)))

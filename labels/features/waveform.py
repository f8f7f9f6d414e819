"""Features of the waveform above half a turn of the shaft: how impulsive it is, whatever its scale and drift."""

from __future__ import annotations

import numpy as np

from labels.features.analysis import Analysis
from labels.features.feature import Feature
from physics.arrays import Array, ComplexArray
from physics.rms import rms

DYER = "Dyer & Stewart 1978, J. Mech. Design 100"
SHAPES = "Lei et al. 2008, Expert Syst. Appl. 35, table of dimensionless parameters"
KURTOGRAM = "Antoni 2007, Mech. Syst. Signal Process. 21 (fast kurtogram)"

# What knocks, crackles or cavitates without any order is more impulsive than spalls are: beyond this, impulsiveness
# says no more of a spall.
MOST_KURTOSIS = 5.0

ROWS = (
    Feature("kurtosis", "ln", "ln of the kurtosis of the waveform above half a turn, 5 at most; ln 3 for noise.", DYER),
    Feature("skewness", "1", "Size of the waveform's skewness, cut at 5.", SHAPES),
    Feature("crest_factor", "ln", "ln of the 99.99 % quantile of the size over the RMS.", DYER),
    Feature("shape_factor", "ln", "ln of the RMS over the mean size.", SHAPES),
    Feature("impulse_factor", "ln", "ln of the 99.9 % quantile of the size over the mean size.", SHAPES),
    Feature("flat_kurtosis", "ln", "ln of the kurtosis of the waveform with a flattened spectrum.", KURTOGRAM),
    Feature("band_kurtosis", "ln", "ln(1 + largest spectral kurtosis of a band).", KURTOGRAM),
    Feature("median_band_kurtosis", "ln", "ln(1 + median spectral kurtosis of the bands).", KURTOGRAM),
)


def measure(analysis: Analysis) -> dict[str, float]:
    """Values of ROWS by name."""
    wave = analysis.record.waveform(_without_drift(analysis))
    wave = wave / rms(wave)
    size = np.abs(wave)
    mean = float(size.mean())
    high, higher = np.quantile(size, (0.999, 0.9999))
    kurtosis = np.maximum(analysis.envelopes.kurtosis, 0.0)
    return {
        "kurtosis": min(_log_kurtosis(wave), float(np.log(MOST_KURTOSIS))),
        "skewness": min(abs(float(np.mean(wave * wave * wave))), 5.0),
        "crest_factor": float(np.log(higher)),
        "shape_factor": float(-np.log(mean)),
        "impulse_factor": float(np.log(high / mean)),
        "flat_kurtosis": _log_kurtosis(analysis.record.waveform(analysis.record.flat)),
        "band_kurtosis": float(np.log1p(kurtosis.max())),
        "median_band_kurtosis": float(np.log1p(np.median(kurtosis))),
    }


def _without_drift(analysis: Analysis) -> ComplexArray:
    """The raw spectrum above where sensors drift, or all of it where nothing else is there."""
    steady = analysis.record.raw.copy()
    steady[: int(analysis.drift_hz / analysis.record.step) + 1] = 0.0
    return steady if steady.any() else analysis.record.raw


def _log_kurtosis(wave: Array) -> float:
    square = wave**2
    return float(np.log(np.mean(square**2) / square.mean() ** 2))

"""Prewhitening: the record with the ringing of its machine taken away, so that events stand alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve, solve_toeplitz

from labels.spall_size.signal.divisors import TINIEST
from physics.arrays import Array

# Samples of the past from which a sample is predicted.
ORDER = 30
# How often the predictor is fitted anew with weights from its residual.
REWEIGHTINGS = 2
# Share of the residual's mean power that is added to each of its squares before they become weights.
FLOOR_SHARE = 0.02
# Share of a sample's power that is added to it alone, so that the predictor is defined whatever the signal.
RIDGE = 1e-9
# Residuals below this share of the signal's RMS are rounding: of a signal that is silent most of the time.
ROUNDING = 1e-9
# Samples whose products are summed at a time, to bound the memory.
BLOCK = 1 << 12


@dataclass(frozen=True)
class Prewhitened:
    """`residual` (T,) of a linear prediction, in units of its median magnitude; `unit`: that in the signal's own."""

    residual: Array
    unit: float


def prewhitened(signal: Array) -> Prewhitened:
    """The residual of a linear prediction of `signal` (T,) from its past.

    A predictor by least squares would also learn the echo of a spall's exit after its entry; weights that fall with
    the size of the residual make it learn the free ringing between events instead. Prediction looks back only, so an
    event starts where it starts.
    """
    x = np.asarray(signal, dtype=np.float64) - np.mean(signal)
    scale = float(x.std())
    if scale == 0.0:
        return Prewhitened(np.zeros_like(x), 0.0)
    x = x / scale
    coefficients = _least_squares_start(x)
    for _ in range(REWEIGHTINGS):
        coefficients = _reweighted(x, coefficients)
    residual = _residual(x, coefficients)
    unit = max(float(np.median(np.abs(residual))), ROUNDING)
    return Prewhitened(residual / unit, unit * scale)


def _least_squares_start(x: Array) -> Array:
    spectrum = np.fft.rfft(x, 2 * x.size)
    covariance = np.fft.irfft(np.abs(spectrum) ** 2)[: ORDER + 1]
    covariance[0] *= 1.0 + RIDGE
    return np.asarray(solve_toeplitz(covariance[:ORDER], covariance[1:]))


def _residual(x: Array, coefficients: Array) -> Array:
    whole = np.convolve(x, np.concatenate([[1.0], -coefficients]))[: x.size]
    whole[: coefficients.size] = 0.0
    return whole


def _reweighted(x: Array, coefficients: Array) -> Array:
    power = _residual(x, coefficients) ** 2
    weight = 1.0 / (power + FLOOR_SHARE * power.mean() + TINIEST)
    # Of the products of a sample and its ORDER predecessors, the last column is that of the sample itself.
    products = np.zeros((ORDER + 1, ORDER + 1))
    past = np.lib.stride_tricks.sliding_window_view(x, ORDER + 1)
    root = np.sqrt(weight[ORDER:, None])
    for start in range(0, past.shape[0], BLOCK):
        rows = root[start : start + BLOCK] * past[start : start + BLOCK]
        products += rows.T @ rows
    gram, target = products[:ORDER, :ORDER], products[:ORDER, ORDER]
    gram[np.diag_indices(ORDER)] += RIDGE * np.trace(gram) / ORDER
    return np.asarray(solve(gram, target, assume_a="pos"))[::-1]

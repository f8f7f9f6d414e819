"""What several physics tests measure by: how loud a signal is, and how far a ball hangs into a gap."""

import numpy as np


def rms(values):
    """Root of the mean square of all `values`, in their unit."""
    return float(np.sqrt(np.mean(values**2)))


def hanging(race, race_radius, ball_radius, psi):
    """Drop at ψ (rad) from a sharp edge, m: Rb − √(Rb² − R² sin²ψ) ∓ R (1 − cos ψ), − outer race, + inner race."""
    sag = ball_radius - np.sqrt(ball_radius**2 - race_radius**2 * np.sin(psi) ** 2)
    return sag + (-1 if race == "outer" else 1) * race_radius * (1 - np.cos(psi))

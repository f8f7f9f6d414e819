"""How far a ball hangs into a gap, by which several physics tests measure."""

import numpy as np


def hanging(race, race_radius, ball_radius, psi):
    """Drop at ψ (rad) from a sharp edge, m: Rb − √(Rb² − R² sin²ψ) ∓ R (1 − cos ψ), − outer race, + inner race."""
    sag = ball_radius - np.sqrt(ball_radius**2 - race_radius**2 * np.sin(psi) ** 2)
    return sag + (-1 if race == "outer" else 1) * race_radius * (1 - np.cos(psi))

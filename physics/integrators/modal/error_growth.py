"""What becomes of an error of a step: how strongly it rings in the modes, and how long contacts may make it grow."""

from __future__ import annotations

import math

import numpy as np

from physics.arrays import Array
from physics.integrators.modal.flow import DISPLACEMENT, OUTPUT, LinearFlow, complex_modes

# How many times its decay contacts may shift a mode before errors count as fed by them. Scenes are known where errors
# grew unseen by a short pilot, two with ratios of 0.4 and 1.6 and all others with 4.3 to 62. Of the wide corpus two
# scenes in five have a ratio above 4.
FEEDING = 4.0

# Lines of a spectrum on the way up to a frequency, and round each mode.
SPECTRUM_LINES = 801


def ringing(flow: LinearFlow, duration: float) -> float:
    """What a push of 1 N s between the rings leaves in the resonator's acceleration: ∫ a² dt, m²/s³ per (N s)².

    The larger of both directions. A mode that rings on for longer than `duration` (s) counts as if it did not.
    """
    sums = []
    for axis in range(2):
        rate, kick, read = complex_modes(flow, (flow.rate, flow.kick, flow.read[OUTPUT]), axis)
        rate, share = np.minimum(rate.real, -0.5 / duration) + 1j * rate.imag, read.conj() * kick
        # Re(s e^λt) Re(s' e^λ't), integrated from 0 to ∞, for all pairs of modes.
        same = share[:, None] * share / (rate[:, None] + rate)
        mixed = share[:, None] * share.conj() / (rate[:, None] + rate.conj())
        sums.append(-0.5 * float((same + mixed).sum().real))
    return max(sums)


def share_below(flow: LinearFlow, duration: float, frequency: float) -> float:
    """The share of the RMS of what a push leaves in the resonator's acceleration that lies below a `frequency` (Hz).

    The larger of both directions; `duration` (s) as for `ringing`.
    """
    shares = []
    for axis in range(2):
        rate, kick, read = complex_modes(flow, (flow.rate, flow.kick, flow.read[OUTPUT]), axis)
        rate, share = np.minimum(rate.real, -0.5 / duration) + 1j * rate.imag, read.conj() * kick
        # Dense where a mode rings, of whatever width.
        round_modes = rate.imag[:, None] - rate.real[:, None] * np.tan(np.linspace(-1.57, 1.57, SPECTRUM_LINES))
        end = 2.0 * math.pi * frequency
        lines = np.unique(
            np.clip(np.concatenate([round_modes.ravel(), np.linspace(0.0, end, SPECTRUM_LINES)]), 0.0, None)
        )
        turning = 1j * lines[:, None]
        answer = 0.5 * (share / (turning - rate) + share.conj() / (turning - rate.conj())).sum(axis=1)
        power = np.abs(answer) ** 2
        below = lines <= end
        shares.append(math.sqrt(np.trapezoid(power[below], lines[below]) / np.trapezoid(power, lines)))
    return max(shares)


def memory_of_errors(flow: LinearFlow, swing: Array) -> float:
    """Time constant (s) of the slowest mode that contacts whose stiffness swings by `swing` (2,), N/m, may feed: 0 if
    none is.

    A change of stiffness moves an eigenvalue by the mode's answer to the force that goes with it. Where that is many
    times the decay, errors may grow from one swing to the next for as long as the mode rings.
    """
    longest = 0.0
    for axis in range(2):
        rate, kick, read = complex_modes(flow, (flow.rate, flow.kick, flow.read[DISPLACEMENT]), axis)
        fed = 0.5 * swing[axis] * np.abs(kick * read) > FEEDING * np.abs(rate.real)
        slowest = float(np.abs(rate.real[fed]).min(initial=math.inf))
        longest = max(longest, 1.0 / slowest if slowest > 0.0 else math.inf)
    return longest

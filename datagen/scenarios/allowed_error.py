"""The error that the simulation of a record may have: a share of its signal, or as much as its own noise would hide."""

from __future__ import annotations

from datagen.scenarios.scenario import Scenario

# However much noise there is, contact changes and spectra stay those of the scene.
LOOSEST = 0.03


def allowed_error(scenario: Scenario) -> tuple[float, float]:
    """Relative RMS error, and RMS error (m/s²), that the simulation of `scenario` may have; the larger one counts.

    An error reaches the recorder by the resonator and by every sensor mode, so their gains are added up.
    """
    accuracy, target = scenario.accuracy, scenario.noise_target
    if accuracy.below_noise_db is None:
        return accuracy.relative, 0.0
    share = 10.0 ** (-accuracy.below_noise_db / 20.0)
    if target is not None:
        hidden = share * 10.0 ** (-target.ratio_db / 20.0) if target.whole and scenario.background.noisy else 0.0
        return max(accuracy.relative, min(LOOSEST, hidden)), 0.0
    gain = scenario.chain.resonator_gain + sum(mode.gain for mode in scenario.chain.modes)
    return accuracy.relative, share * scenario.background.white_rms / gain if gain > 0.0 else 0.0

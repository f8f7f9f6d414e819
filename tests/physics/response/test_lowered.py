"""Responses whose rate is lowered, after which less may be left of the signal than of its error."""

from dataclasses import dataclass

import numpy as np
import pytest

from physics.integrators.modal.error_growth import share_below
from physics.integrators.modal.flow import OUTPUT, complex_modes
from physics.motion import motion_model
from physics.reference_scenes import reference_scene
from physics.request import Accurate, LeadIn
from physics.response.lowered import respond_lowered
from physics.response.modal_case import mean_flow
from physics.rms import relative_error
from physics.simulate import simulate
from physics.statics.load_distribution import resting


@pytest.mark.slow
@pytest.mark.parametrize(("name", "rate", "times"), [("F1", 2000.0, 40.0), ("F2r", 700.0, 30.0)])
def test_a_fast_machine_recorded_slowly_keeps_the_accuracy_of_what_is_recorded(name, rate, times):
    """Its ball passes lie above what is recorded, which holds less than a thousandth of the signal."""
    scene = reference_scene(name, 1.5, speed_factor=times)
    usual, exact = (simulate(scene, rate, Accurate(accuracy), lead_in=LeadIn(0.5)) for accuracy in (1e-3, 1e-5))
    error = relative_error(usual.acceleration, exact.acceleration)
    assert error < 1e-3  # 3.9e-3 while errors were held against the whole signal
    assert error < usual.error_estimate <= 1e-3


@pytest.mark.parametrize("frequency", [350.0, 2000.0, 9000.0, 1e6])
def test_the_share_of_a_push_below_a_frequency_is_that_of_its_spectrum(frequency):
    scene = reference_scene("G0", 0.5)
    flow, rate = mean_flow(motion_model(scene), resting(scene)), 2.0**18
    time, shares = np.arange(2**18) / rate, []
    for axis in range(2):
        value, kick, read = complex_modes(flow, (flow.rate, flow.kick, flow.read[OUTPUT]), axis)
        left = sum((s * np.exp(v * time)).real for s, v in zip(read.conj() * kick, value, strict=True))
        power = np.abs(np.fft.rfft(left)) ** 2
        below = np.fft.rfftfreq(time.size, 1.0 / rate) <= frequency
        shares.append(np.sqrt(power[below].sum() / power.sum()))
    assert share_below(flow, 0.5, frequency) == pytest.approx(max(shares), rel=0.05)  # it is sampled, and aliases


@dataclass
class Lowered:
    """What of a trace counts here."""

    acceleration: np.ndarray
    error_estimate: float
    chaotic: bool


def trace(size, error, chaotic=False):
    return Lowered(acceleration=np.full((4, 2), size), error_estimate=error, chaotic=chaotic)


def test_the_share_that_is_left_of_an_error_is_held_against_what_is_left_of_the_signal():
    asked = []

    def respond(accuracy):
        asked.append(accuracy)
        return trace(0.05, accuracy), 1.0

    found = respond_lowered(respond, 0.2, 1e-3, 0.0)
    # 0.2 · 1e-3 of 1 m/s² is 4e-3 of the 0.05 m/s² that are left: four times what is allowed.
    assert asked == pytest.approx([1e-3, 0.9 * 1e-3 / 4.0])
    assert found.error_estimate == pytest.approx(0.2 * asked[-1] / 0.05)


def test_no_response_is_said_to_be_more_exact_behind_the_low_pass_than_before_it():
    found = respond_lowered(lambda accuracy: (trace(0.5, accuracy), 1.0), 0.01, 1e-3, 0.0)
    assert found.error_estimate == 1e-3  # 0.01 · 1e-3 / 0.5 is less


def test_what_is_left_of_a_chaotic_response_is_not_made_again():
    asked = []

    def respond(accuracy):
        asked.append(accuracy)
        return trace(1e-3, 1.0, chaotic=True), 1.0

    assert respond_lowered(respond, 0.5, 1e-3, 0.0).chaotic
    assert asked == [1e-3]


def test_an_error_that_is_allowed_anyway_needs_no_other_response():
    asked = []

    def quiet(accuracy):
        asked.append(accuracy)
        return trace(0.0, 1e-3), 1.0

    assert respond_lowered(quiet, 0.1, 1e-3, 1e-3).error_estimate == 1e-3
    assert asked == [1e-3]


def test_a_response_is_made_three_times_at_most():
    asked = []

    def respond(accuracy):
        asked.append(accuracy)
        return trace(0.5, 1e-3), 1.0  # never more exact

    respond_lowered(respond, 1.0, 1e-3, 0.0)
    assert asked == pytest.approx([1e-3, 0.45e-3, 0.45**2 * 1e-3])


def test_nothing_is_asked_again_at_the_smallest_accuracy():
    asked = []

    def respond(accuracy):
        asked.append(accuracy)
        return trace(1e-6, accuracy), 1.0

    assert respond_lowered(respond, 1.0, 1e-6, 0.0).error_estimate == pytest.approx(1.0)
    assert asked == [1e-6]
    respond_lowered(respond, 1.0, 1e-3, 0.0)
    assert asked == [1e-6, 1e-3, 1e-6]

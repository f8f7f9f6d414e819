"""What a ball does on its way over a line spall, against the paper and an independent implementation of its model.

Numbers said to be measured are those of that implementation; where it did not say how they were taken, the reading
chosen here is in the docstring of the test.
"""

import dataclasses
import math

import numpy as np
import pytest
from scipy.optimize import brentq

from labels.truth import ball_passes
from physics.modes import modes
from physics.simulate import simulate
from physics.statics.load_distribution import equilibrium
from physics.statics.stiffness import symmetric_matrices

RATE = 65536.0
SETTLED = 0.1
COUPLED_RESONATOR = 9900.0
LOW_BAND = (0.0, 3000.0)
HIGH_BAND = (0.85 * COUPLED_RESONATOR, 1.15 * COUPLED_RESONATOR)


def band_passed(signal, band):
    """The part of `signal` in `band` (Hz), without delay."""
    spectrum = np.fft.rfft(signal)
    frequency = np.fft.rfftfreq(signal.size, 1.0 / RATE)
    spectrum[(frequency < band[0]) | (frequency > band[1])] = 0.0
    return np.fft.irfft(spectrum, signal.size)


def complete_passes(scene, trace):
    """Entry, exit, release and regain times (P,) of the passes that lie wholly after the start has died away, s."""
    table = ball_passes(scene, trace.changes, scene.duration)
    whole = table.complete & (table.entry_time > SETTLED)
    return (getattr(table, name)[whole] for name in ("entry_time", "exit_time", "release_time", "regain_time"))


def entry_over_exit(scene, trace, band):
    """Peak of |y acceleration| in `band` after entry over that around exit, mean over the passes.

    After entry: from there to mid-spall. Around exit: from 0.15 of the pass before it to half a pass after it.
    """
    signal = np.abs(band_passed(trace.acceleration[:, 1], band))
    entry, leave, _, _ = complete_passes(scene, trace)
    duration = np.mean(leave - entry)

    def peak(start, stop):
        return np.mean([signal[math.ceil(a * RATE) : int(b * RATE)].max() for a, b in zip(start, stop, strict=True)])

    middle = entry + 0.5 * duration
    return peak(entry, middle) / peak(leave - 0.15 * duration, leave + 0.5 * duration)


def deep_gap_drop(scene, arc):
    """Drop (m) of a ball over a deep gap on the outer race, at the arc (rad) from the nearer edge."""
    race, ball = scene.rig.bearing.raceway_radius("outer"), scene.rig.bearing.ball_radius
    return ball - math.sqrt(ball**2 - (race * math.sin(arc)) ** 2) - race * (1.0 - math.cos(arc))


def test_a_healthy_balls_compression_releases_it_for_0_47_of_the_gearbox_rigs_deep_gap(reference_scene):
    healthy, gap = reference_scene("G0"), reference_scene("G1p")
    peak_load = equilibrium(healthy, np.zeros(1)).ball_load.max()
    compression = (peak_load / healthy.rig.bearing.load_deflection) ** (1.0 / healthy.rig.bearing.exponent)
    half = gap.spalls[0].extent / 2.0
    released = brentq(lambda arc: deep_gap_drop(gap, arc) - compression, 0.0, half)
    assert compression == pytest.approx(5.3e-6, abs=0.05e-6)  # m, measured, half a last digit
    assert 1.0 - released / half == pytest.approx(0.47, abs=0.005)  # measured, half a last digit


@pytest.fixture(scope="module")
def unloaded_share(reference_scene):
    """Share of the gearbox rig's deep gap over which ball 10 of row 1 carries nothing in quasi-static equilibrium."""
    scene = reference_scene("G1p")
    half = scene.spalls[0].extent / 2.0
    arc = np.linspace(-half, half, 4001)
    time = arc / scene.cage.mean_speed + 2.0 * np.pi / scene.cage.mean_speed  # the ball starts at 270 degrees
    return np.mean(equilibrium(scene, time).ball_load[:, 0, 9] == 0.0)


def test_the_other_balls_take_over_and_let_the_ball_be_released_a_little_later(unloaded_share):
    # 0.436: the shaft sinks by 0.7 um as the others take the load, which 0.47 leaves out.
    assert 0.40 < unloaded_share < 0.47


def test_release_and_regain_of_the_simulated_ball_are_the_quasi_static_ones(unloaded_share, reference_scene):
    scene = reference_scene("G1p")
    entry, leave, release, regain = complete_passes(scene, simulate(scene, RATE))
    share = (regain - release) / (leave - entry)
    assert share.size >= 10
    assert share == pytest.approx(unloaded_share, abs=0.005)  # the 2.2 kHz mode has 12 periods in the time between


def test_with_equal_tapers_the_resonator_answers_to_entry_as_to_exit(reference_scene, reference_trace):
    """Measured: ratio 1.01 on the fan rig at 800 rpm. Band: the coupled resonator's 9.9 kHz ± 15 %."""
    ratio = entry_over_exit(reference_scene("F1"), reference_trace("F1"), HIGH_BAND)
    assert ratio == pytest.approx(1.01, abs=0.1)  # 0.94; 0.87 to 1.06 in other bands and with RMS for peaks


def test_with_a_gradual_entry_the_resonator_hardly_answers_to_it(reference_scene, reference_trace):
    """Measured: ratio 0.07. Bands from 4 kHz up give 0.08 to 0.12, those narrower than the event is short more."""
    ratio = entry_over_exit(reference_scene("F1s"), reference_trace("F1s"), HIGH_BAND)
    assert ratio == pytest.approx(0.07, abs=0.02)  # 0.084: the film's pull, let go at release, is what is left of entry


def test_with_a_gradual_entry_the_low_band_still_shows_it(reference_scene, reference_trace):
    """Measured: ratio 0.8, in a band that is not named; here below 3 kHz, where the ring modes lie."""
    ratio = entry_over_exit(reference_scene("F1s"), reference_trace("F1s"), LOW_BAND)
    assert ratio == pytest.approx(0.8, abs=0.1)  # 0.73; 0.69 to 0.99 with other bands, windows and RMS for peaks


def mean_spectrum(signal, starts, length, size=2**16):
    """RMS over the starts (s) of the spectra of `length` samples each, faded out, on `size` points, and frequencies."""
    fade = np.hanning(2 * length)[length:]
    pieces = [signal[first : first + length] for first in (np.asarray(starts) * RATE).astype(int)]
    spectra = [np.abs(np.fft.rfft((piece - piece.mean()) * fade, size)) for piece in pieces]
    return np.sqrt(np.mean(np.square(spectra), axis=0)), np.fft.rfftfreq(size, 1.0 / RATE)


def peak_frequencies(amplitude, frequency, count):
    """Frequencies (Hz) of the `count` highest local maxima between 0.7 and 12 kHz, rising."""
    inner = (amplitude[1:-1] > amplitude[2:]) & (amplitude[1:-1] >= amplitude[:-2])
    place = np.flatnonzero(inner) + 1
    place = place[(frequency[place] > 700.0) & (frequency[place] < 12000.0)]
    return np.sort(frequency[place[np.argsort(amplitude[place])[::-1][:count]]])


@pytest.fixture(scope="module")
def postponed_exit(reference_scene):
    """F1s with its exit 20 degrees after its entry, so that what entry excites can ring alone for ten milliseconds."""
    scene = reference_scene("F1s")
    near = scene.spalls[0]
    far = dataclasses.replace(near, extent=math.radians(20.0))
    return dataclasses.replace(scene, spalls=(far,))


def level(amplitude, frequency, low, high):
    return amplitude[(frequency > low) & (frequency < high)].max()


def test_a_gradual_entry_excites_0_90_and_1_99_khz_and_hardly_the_resonator(postponed_exit):
    trace = simulate(postponed_exit, RATE)
    entry, leave, _, _ = complete_passes(postponed_exit, trace)
    length = int(np.mean(leave - entry) * RATE) - 20
    amplitude, frequency = mean_spectrum(trace.acceleration[:, 1], entry, length)
    # 5 %: ten milliseconds tell 100 Hz apart, and the bearing is softer while the ball hangs in the spall.
    assert peak_frequencies(amplitude, frequency, 2) == pytest.approx([900.0, 1990.0], rel=0.05)
    after, _ = mean_spectrum(trace.acceleration[:, 1], leave - 10.0 / RATE, 160)
    resonator = level(amplitude, frequency, 9000.0, 10800.0)
    assert resonator < 0.1 * level(amplitude, frequency, 700.0, 2500.0)  # 0.04
    assert resonator < 0.15 * level(after, frequency, 9000.0, 10800.0)  # 0.10: exit, from the same distance


def test_a_sharp_exit_excites_0_90_and_1_99_khz_and_the_resonator_at_9_9_khz(reference_scene, reference_trace):
    scene, trace = reference_scene("F1s"), reference_trace("F1s")
    _, leave, _, _ = complete_passes(scene, trace)
    amplitude, frequency = mean_spectrum(trace.acceleration[:, 1], leave - 10.0 / RATE, 600)
    rest = equilibrium(reference_scene("F0"), np.zeros(1))
    linear = modes(scene.rig, symmetric_matrices(rest.stiffness[0]), symmetric_matrices(rest.damping[0])).frequency_hz
    # 9 ms tell 110 Hz apart, hence 10 % of the lowest.
    assert peak_frequencies(amplitude, frequency, 3) == pytest.approx(linear[[1, 3, 5]], rel=0.1)
    assert peak_frequencies(amplitude, frequency, 3)[1:] == pytest.approx(linear[[3, 5]], rel=0.02)

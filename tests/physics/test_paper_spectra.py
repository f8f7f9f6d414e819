"""The paper's claims on spectra of line and extended spalls, and slip that no step changes.

Numbers said to be measured are those of an independent implementation of the paper's model, on the gearbox rig with 1 %
slip over 1.4 s, spectra with a Hann window. Its random numbers are not ours.
"""

import numpy as np
import pytest

from labels.envelope import band_envelope, default_band, squared_envelope_spectrum
from labels.spectrum import amplitude_spectrum, line_amplitude
from labels.truth import ball_passes
from physics.crossing import crossing_times

RATE = 65536.0
DURATION, ANALYSED = 1.5, 1.4
PAPER_BAND = (10200.0, 10400.0)
BPFO = 34.283
LINE_WIDTH = 1.5  # Hz either side of a harmonic: twice the bin spacing of 1.4 s
SEEDS = range(10)


@pytest.fixture(scope="module")
def record(reference_trace):
    """The y acceleration (T,) of the last 1.4 s of a reference scene with slip."""

    def last_part(name, seed):
        rough = {"roughness_seed": 100 + seed} if name.endswith("r") else {}
        trace = reference_trace(name, DURATION, 1, slip_seed=seed, **rough)
        return trace.acceleration[-round(ANALYSED * RATE) :, 1]

    return last_part


def envelope_line(signal, band=PAPER_BAND):
    """Height of the BPFO line of the squared envelope's spectrum in a band (Hz), (m/s²)²."""
    frequency, amplitude = squared_envelope_spectrum(band_envelope(signal, RATE, band), RATE)
    return line_amplitude(frequency, amplitude, BPFO, LINE_WIDTH)


def velocity_harmonics(signal, count=14):
    """Heights (count,) of the BPFO harmonics of the velocity spectrum, m/s."""
    frequency, acceleration = amplitude_spectrum(signal, RATE)
    frequency, amplitude = frequency[1:], acceleration[1:] / (2.0 * np.pi * frequency[1:])
    return np.array([line_amplitude(frequency, amplitude, BPFO * k, LINE_WIDTH) for k in range(1, count + 1)])


def decibel(ratio):
    return 20.0 * np.log10(ratio)


def test_the_line_spalls_envelope_line_is_thousands_of_times_that_of_a_smooth_extended_spall(record):
    ratios = [envelope_line(record("G1", seed)) / envelope_line(record("G2", seed)) for seed in range(5)]
    assert min(ratios) > 1000.0  # "thousands"; 5800 to 6500
    assert max(ratios) < 10000.0


def test_the_line_spalls_envelope_line_is_about_ten_times_that_of_a_rough_extended_spall(record):
    """Measured: 6.8 to 12 for five seeds. Ours are others: the middle of ten seeds has to be about ten, none below 1.

    It depends on what a low-pass "at the contact width" w is: over forty seeds a Gaussian with half amplitude at the
    wavelength w gives 1.3, at 1.5 w 8, at 1.75 w 10 and at 2 w 16, each with quartiles a factor 1.5 to 1.8 away.
    """
    ratios = [envelope_line(record("G1", seed)) / envelope_line(record("G2r", seed)) for seed in SEEDS]
    assert 5.0 < np.median(ratios) < 20.0  # ten times or so: a factor of two, the middle of ten scatters by a quarter
    assert min(ratios) > 1.0


def test_in_a_band_that_holds_the_coupled_resonator_the_ratio_to_the_rough_spall_scatters_more(record, gearbox):
    """Measured: 1 to 70 times, seed by seed. Ours are others, so that one in ten may lie outside."""
    band = default_band(gearbox, RATE)
    ratios = np.array([envelope_line(record("G1", s), band) / envelope_line(record("G2r", s), band) for s in SEEDS])
    assert np.count_nonzero((ratios > 1.0) & (ratios < 70.0)) >= 9


def test_the_sixth_bpfo_harmonic_of_the_smooth_extended_spalls_velocity_is_the_strongest(record):
    for seed in range(5):
        assert np.argmax(velocity_harmonics(record("G2", seed))) + 1 == 6


def test_the_sixth_bpfo_harmonic_of_the_rough_extended_spalls_velocity_is_the_strongest_for_eight_seeds_in_ten(record):
    strongest = [np.argmax(velocity_harmonics(record("G2r", seed))) + 1 for seed in SEEDS]
    assert strongest.count(6) >= 8  # measured 9 of 10; one seed more or less of ten is chance


def test_the_rough_extended_spalls_first_three_harmonics_lie_3_to_9_db_above_the_line_spalls(record):
    """Measured: 3 to 9 dB, one seed in ten not. Read as the mean of the three harmonics' decibels.

    One by one they lie about 12, 8 and -4 dB above the line spall's, for any seed.
    """
    above = [
        np.mean(decibel(velocity_harmonics(record("G2r", seed), 3) / velocity_harmonics(record("G1", seed), 3)))
        for seed in SEEDS
    ]
    assert sum(3.0 < value < 9.0 for value in above) >= 8  # one seed more or less of ten is chance
    assert 3.0 < np.median(above) < 9.0


def test_the_rough_extended_spalls_sixth_harmonic_itself_lies_below_the_line_spalls_in_most(record):
    """Measured: 2 to 7 dB below in most; the paper, whose profile is not printed, shows it above.

    Over forty seeds six to eight in ten lie below, by 2 dB or 1 dB in the middle, depending on the roughness filter.
    """
    above = [
        decibel(velocity_harmonics(record("G2r", seed), 6)[5] / velocity_harmonics(record("G1", seed), 6)[5])
        for seed in SEEDS
    ]
    assert sum(value < 0.0 for value in above) > 5
    assert -7.0 < np.median(above) < 0.0


def test_halving_the_step_moves_neither_scatter_nor_mean_of_the_time_between_balls(reference_scene, reference_trace):
    scene = reference_scene("G1", DURATION, slip_seed=2)
    periods = []
    for substeps in (1, 2):
        trace = reference_trace("G1", DURATION, substeps, slip_seed=2)
        regain = ball_passes(scene, trace.changes, DURATION).regain_time
        periods.append(np.diff(regain[np.isfinite(regain)]))
    assert periods[0] == pytest.approx(periods[1], abs=1e-9)  # s: contact is regained on the same path of the cage
    cage, places = scene.cage, scene.rig.bearing.spacing * np.arange(1, periods[0].size + 2)
    on_the_path = np.diff(crossing_times(cage.polynomial, cage.mean_speed, cage.duration, places))
    assert np.std(on_the_path) > 0.004 * np.mean(on_the_path)
    # Balls are regained at a place that moves by a hundredth of a pass, not where the path's periods are counted.
    assert np.std(periods[0]) == pytest.approx(np.std(on_the_path), rel=0.1)


def test_halving_the_step_moves_no_smeared_harmonic(reference_trace):
    lines = {}
    for key, substeps, choices in (
        ("slipping", 1, {"slip_seed": 2}),
        ("slipping, half the step", 2, {"slip_seed": 2}),
        ("steady", 1, {}),
    ):
        signal = reference_trace("G1", DURATION, substeps, **choices).acceleration[-round(ANALYSED * RATE) :, 1]
        frequency, amplitude = amplitude_spectrum(signal, RATE)
        lines[key] = np.array([line_amplitude(frequency, amplitude, BPFO * k, LINE_WIDTH) for k in range(1, 61)])
    scale = np.median(lines["slipping"])
    assert lines["slipping"] == pytest.approx(lines["slipping, half the step"], abs=1e-3 * scale, rel=1e-3)
    assert np.median(lines["steady"][30:] / lines["slipping"][30:]) > 1.5  # 2.0: harmonics above 1 kHz are smeared

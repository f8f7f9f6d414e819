import math

import numpy as np
import pytest

from physics.backgrounds.gear_mesh import GearMesh, gear_mesh
from physics.backgrounds.impulses import Impulses, Resonance, impulses
from physics.backgrounds.mains_hum import MainsHum, mains_hum
from physics.backgrounds.pink import PinkNoise, pink_density, pink_noise
from physics.backgrounds.recording import draw_starts
from physics.backgrounds.shaft_harmonics import ShaftHarmonics, shaft_harmonics
from physics.backgrounds.tones import tones
from physics.backgrounds.white import white_noise
from physics.checks import InvalidParameter
from physics.sensor.chain import SensorChain
from physics.sensor.mode import SensorMode

RATE, SAMPLES = 8192.0, 16384  # bins 0.5 Hz apart


def spectrum(signal):
    """One-sided amplitude spectrum of the y axis and its frequencies."""
    return np.fft.rfftfreq(SAMPLES, 1.0 / RATE), np.abs(np.fft.rfft(signal[:, 1])) * 2.0 / SAMPLES


def lines(signal):
    """Frequencies and heights of all lines above 1e-9."""
    frequency, amplitude = spectrum(signal)
    high = amplitude > 1e-9
    return dict(zip(frequency[high].tolist(), amplitude[high].tolist(), strict=True))


def twice(draw):
    """The same draw from two generators of one seed, and from one of another seed."""
    return [draw(np.random.default_rng(seed)) for seed in (4, 4, 5)]


DRAWS = {
    "white": lambda generator: white_noise(generator, 2.0, 256),
    "pink": lambda generator: pink_noise(generator, PinkNoise(2.0, 30.0), 256, RATE),
    "shaft_harmonics": lambda generator: shaft_harmonics(generator, ShaftHarmonics((1.0,)), 100.0, 256, RATE),
    "gear_mesh": lambda generator: gear_mesh(generator, GearMesh(20, (1.0,)), 100.0, 256, RATE),
    "mains_hum": lambda generator: mains_hum(generator, MainsHum(50.0, (1.0,)), 256, RATE),
    "impulses": lambda generator: impulses(generator, Impulses(1000.0, 1.0, 0.5, (Resonance(900.0, 0.05),)), 256, RATE),
}


@pytest.mark.parametrize("name", DRAWS)
def test_a_layer_is_a_pure_function_of_its_generator_with_two_axes_that_differ(name):
    first, again, other = twice(DRAWS[name])
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)
    assert first.shape == (256, 2)
    assert first.dtype == np.float64
    assert not np.array_equal(first[:, 0], first[:, 1])


def test_white_noise_has_its_level_in_every_octave():
    noise = white_noise(np.random.default_rng(1), 3.0, SAMPLES)
    power = np.abs(np.fft.rfft(noise, axis=0)) ** 2 * 2.0 / SAMPLES**2
    for low in (512, 1024, 2048, 4096):
        # n bins of two axes: the mean of 2n exponential numbers scatters by 1/sqrt(2n) = 3 % at most; four of them
        assert power[low : 2 * low].mean() * SAMPLES / 2.0 == pytest.approx(9.0, rel=0.125)


@pytest.mark.parametrize("slope", [0.0, 1.0, 1.6, 2.0])
def test_pink_noise_has_its_slope_its_rms_and_nothing_below_its_lowest_frequency(slope):
    generator, noise = np.random.default_rng(2), PinkNoise(2.5, 16.0, slope)
    drawn = np.concatenate([pink_noise(generator, noise, SAMPLES, RATE) for _ in range(60)], axis=1)
    density = (np.abs(np.fft.rfft(drawn, axis=0)) ** 2 * 2.0 / (SAMPLES * RATE)).mean(axis=1)
    frequency = np.fft.rfftfreq(SAMPLES, 1.0 / RATE)
    assert density[frequency < 16.0].max() < 1e-20
    octaves = [(frequency >= low) & (frequency < 2.0 * low) for low in (16.0, 64.0, 256.0, 1024.0)]
    expected = [pink_density(noise, frequency[band], RATE).sum() for band in octaves]
    # 120 draws of at least 32 bins: 1/sqrt(3840) = 1.6 %; four of them
    assert [density[band].sum() for band in octaves] == pytest.approx(expected, rel=0.065)
    # The steepest spectrum lies in a few dozen bins: 1/sqrt(120 · 30) = 1.7 %; four of them
    assert np.mean(drawn**2) == pytest.approx(2.5**2, rel=0.07)


def test_pink_noise_falls_with_the_frequency_from_1_hz_on_unless_it_is_said_otherwise():
    # The integral of c / f from 1 Hz to half the rate is c ln(rate / 2).
    expected = 1.5**2 / (np.log(RATE / 2.0) * np.array([1.0, 2.0, 1000.0]))
    assert pink_density(PinkNoise(1.5), np.array([1.0, 2.0, 1000.0]), RATE) == pytest.approx(expected, rel=1e-12)
    assert pink_density(PinkNoise(1.5), np.array([0.999]), RATE) == 0.0


def test_the_density_of_pink_noise_integrates_to_its_power_and_does_not_know_the_records_length():
    frequency = np.linspace(16.0, RATE / 2.0, 2_000_001)
    for slope in (0.0, 0.7, 1.0, 1.0 + 1e-6, 1.05, 2.0):
        density = pink_density(PinkNoise(2.5, 16.0, slope), frequency, RATE)
        assert np.trapezoid(density, frequency) == pytest.approx(6.25, rel=1e-6)  # trapezoids of 2 mHz


def test_shaft_harmonics_stand_at_multiples_of_the_shaft_with_their_amplitudes():
    layer = ShaftHarmonics((0.5, 0.25, 0.125), 2)
    found = lines(shaft_harmonics(np.random.default_rng(3), layer, 2.0 * math.pi * 24.5, SAMPLES, RATE))
    assert found == pytest.approx({49.0: 0.5, 73.5: 0.25, 98.0: 0.125}, rel=1e-9)


def test_the_gearbox_rigs_mesh_stands_at_224_hz_with_sidebands_of_both_shafts():
    layer = GearMesh(32, (1.0, 0.5), 49, 0.4, 0.2, 2)
    rate, samples = 4096.0, 4096 * 7  # 1/7 Hz bins hold both shafts: 7 Hz and 32 · 7 / 49 = 4 4/7 Hz
    signal = gear_mesh(np.random.default_rng(4), layer, 2.0 * math.pi * 7.0, samples, rate)
    amplitude = np.abs(np.fft.rfft(signal[:, 0])) * 2.0 / samples
    other = 32 * 7.0 / 49.0
    expected = {}
    for mesh, height in ((224.0, 1.0), (448.0, 0.5)):
        expected[mesh] = height
        for side in (-1, 1):
            expected |= {mesh + side * 7.0 * k: height * 0.4**k / 2.0 for k in (1, 2)}
            expected |= {mesh + side * other * k: height * 0.2**k / 2.0 for k in (1, 2)}
    places = {round(frequency * 7): height for frequency, height in expected.items()}
    assert {k: amplitude[k] for k in places} == pytest.approx(places, rel=1e-9)
    assert sorted(np.flatnonzero(amplitude > 1e-9)) == sorted(places)


@pytest.mark.parametrize(("teeth", "other_teeth"), [(5, 3), (2, 1)], ids=["usual", "sidebands below 0 Hz"])
def test_the_mesh_is_the_product_of_its_modulation_and_its_harmonics(teeth, other_teeth):
    layer, speed = GearMesh(teeth, (2.0,), other_teeth, 0.5, 0.25, 3), 90.0
    generator = np.random.default_rng(6)
    signal = gear_mesh(generator, layer, speed, 200, RATE)
    phases = np.random.default_rng(6)
    carrier, own, other = (2.0 * np.pi * phases.random((rows, 2)) for rows in (1, 3, 3))
    turn, modulation = speed * np.arange(200)[:, None] / RATE, 1.0
    for k in range(3):
        modulation = modulation + 0.5 ** (k + 1) * np.cos((k + 1) * turn + own[k])
        modulation += 0.25 ** (k + 1) * np.cos((k + 1) * teeth / other_teeth * turn + other[k])
    assert signal == pytest.approx(2.0 * modulation * np.cos(teeth * turn + carrier), abs=1e-12)  # rounding


def test_a_mesh_whose_other_gear_is_not_known_has_no_sidebands_of_it():
    alone, modulated = (GearMesh(20, (1.0,), 0, 0.5, other) for other in (0.0, 0.3))
    expected, signal = (gear_mesh(np.random.default_rng(6), layer, 90.0, 200, RATE) for layer in (alone, modulated))
    assert np.array_equal(signal, expected)


def test_lines_below_0_hz_lie_at_their_absolute_frequency_and_are_left_out_from_half_the_rate_on():
    def tone(frequency):
        return tones(np.array([frequency]), np.array([2.0]), np.array([[0.3, 0.9]]), 400, RATE)

    turn = 2.0 * np.pi * 100.0 * np.arange(400)[:, None] / RATE
    assert tone(-100.0) == pytest.approx(2.0 * np.cos(turn - np.array([0.3, 0.9])), abs=1e-12)  # rounding
    assert not tone(-RATE / 2.0).any()
    assert not tone(-5000.0).any()


def test_hum_stands_at_multiples_of_the_mains():
    found = lines(mains_hum(np.random.default_rng(7), MainsHum(50.0, (1.0, 0.0, 0.25)), SAMPLES, RATE))
    assert found == pytest.approx({50.0: 1.0, 150.0: 0.25}, rel=1e-9)


@pytest.mark.parametrize(
    "draw",
    [
        lambda generator: mains_hum(generator, MainsHum(3000.0, (1.0, 1.0, 1.0)), SAMPLES, RATE),
        lambda generator: shaft_harmonics(generator, ShaftHarmonics((1.0,) * 3), 6000.0 * math.pi, SAMPLES, RATE),
        lambda generator: gear_mesh(generator, GearMesh(100, (1.0, 1.0)), 60.0 * math.pi, SAMPLES, RATE),
    ],
)
def test_lines_beyond_half_the_rate_are_left_out_and_not_folded_back(draw):
    assert list(lines(draw(np.random.default_rng(8)))) == [3000.0]


def test_a_line_at_half_the_rate_itself_is_left_out():
    assert list(lines(mains_hum(np.random.default_rng(8), MainsHum(RATE / 4.0, (1.0, 1.0)), SAMPLES, RATE))) == [2048.0]


def test_a_single_knock_is_a_decaying_sine_from_an_instant_between_two_samples():
    layer = Impulses(0.3, 4.0, 0.0, (Resonance(700.0, 0.03),))
    seed = next(s for s in range(99) if np.random.default_rng(s).poisson(0.6) == 1)
    signal = impulses(np.random.default_rng(seed), layer, SAMPLES, RATE)
    generator = np.random.default_rng(seed)
    generator.poisson(0.6)
    start = 2.0 * generator.random(1)[0]
    generator.standard_normal(1)
    direction = 2.0 * math.pi * generator.random(1)[0]
    since = np.arange(SAMPLES) / RATE - start
    turn = 2.0 * np.pi * 700.0 * np.maximum(since, 0.0)
    ring = np.where(since >= 0.0, 4.0 * np.exp(-0.03 * turn) * np.sin(turn), 0.0)
    expected = ring[:, None] * np.array([math.cos(direction), math.sin(direction)])
    assert signal == pytest.approx(expected, abs=1e-10)  # rounding grows along the recursion


def test_knocks_that_begin_between_the_same_two_samples_or_behind_the_last_add_up():
    samples, density = 64, 10_000.0
    signal = impulses(np.random.default_rng(0), Impulses(density, 2.0, 0.0, (Resonance(700.0, 0.03),)), samples, RATE)
    generator = np.random.default_rng(0)
    start = samples / RATE * generator.random(generator.poisson(density * samples / RATE))
    generator.standard_normal(start.size)
    direction = 2.0 * math.pi * generator.random(start.size)
    first = np.ceil(start * RATE)
    assert np.unique(first).size < start.size
    assert first.max() == samples
    turn = 2.0 * np.pi * 700.0 * np.maximum(np.arange(samples)[:, None] / RATE - start, 0.0)
    expected = 2.0 * np.exp(-0.03 * turn) * np.sin(turn) @ np.column_stack([np.cos(direction), np.sin(direction)])
    assert signal == pytest.approx(expected, abs=1e-10)  # rounding grows along the recursion


def test_knocks_come_at_their_rate_with_their_median_height():
    rate = 4.0 * RATE
    layer = Impulses(10.0, 2.0, 0.7, (Resonance(1000.0, 0.7),))
    loud = np.hypot(*impulses(np.random.default_rng(9), layer, round(100.0 * rate), rate).T)
    ringing = np.flatnonzero(loud > 0.02)  # a hundredth of the median
    knocks = np.split(ringing, 1 + np.flatnonzero(np.diff(ringing) > 1e-3 * rate))  # quiet for longer than a period
    heights = np.array([loud[knock].max() for knock in knocks])
    # Of a thousand about 2 % come while another rings; a Poisson number scatters by its root, 32; four of them.
    assert heights.size == pytest.approx(980, abs=128)
    turn = math.atan2(1.0, 0.7)  # of the decaying sine at its peak
    peak = 2.0 * math.exp(-0.7 * turn) * math.sin(turn)
    assert np.median(heights) == pytest.approx(peak, rel=0.11)  # 1.25 · 0.7 / sqrt(1000) = 2.8 %; four of them


def test_knocks_share_their_power_among_their_resonances():
    per_second, height, spread = 40.0, 2.0, 0.3
    resonances = Resonance(500.0, 0.01), Resonance(3000.0, 0.01)
    samples = 50 * SAMPLES
    signal = impulses(np.random.default_rng(9), Impulses(per_second, height, spread, resonances), samples, RATE)
    power = np.sum(np.abs(np.fft.rfft(signal, axis=0)) ** 2, axis=1) * 2.0 / samples**2
    low = np.fft.rfftfreq(samples, 1.0 / RATE) < 1500.0
    # The mean square of a share u / (u + v) of two uniform numbers is 1 − ln 2, that of a height A² exp(2 s²).
    strength = per_second * height**2 * math.exp(2.0 * spread**2) * (1.0 - math.log(2.0))
    for one, heard in zip(resonances, (low, ~low), strict=True):
        expected = strength / (
            4.0 * one.damping * 2.0 * math.pi * one.frequency
        )  # integral of the decaying sine squared
        # Of 4000 knocks, whose squares scatter by about their own size: 1.6 %; four of them, and what ringings overlap.
        assert power[heard].sum() == pytest.approx(expected, rel=0.1)


def test_a_knock_is_shared_by_its_resonances_and_its_height_is_log_normal():
    resonances = Resonance(500.0, 0.05), Resonance(3000.0, 0.02)
    seed = next(s for s in range(99) if np.random.default_rng(s).poisson(2.0) == 3)
    signal = impulses(np.random.default_rng(seed), Impulses(1.0, 2.0, 0.7, resonances), SAMPLES, RATE)
    generator = np.random.default_rng(seed)
    generator.poisson(2.0)
    start, height = 2.0 * generator.random(3), 2.0 * np.exp(0.7 * generator.standard_normal(3))
    direction, share = 2.0 * math.pi * generator.random(3), generator.random((3, 2))
    expected = np.zeros((SAMPLES, 2))
    for knock in range(3):
        since = np.maximum(np.arange(SAMPLES) / RATE - start[knock], 0.0)
        for place, one in enumerate(resonances):
            turn = 2.0 * np.pi * one.frequency * since
            ring = height[knock] * share[knock, place] / share[knock].sum() * np.exp(-one.damping * turn) * np.sin(turn)
            expected += ring[:, None] * np.array([math.cos(direction[knock]), math.sin(direction[knock])])
    assert signal == pytest.approx(expected, abs=1e-9)  # rounding grows along the recursion


@pytest.mark.parametrize("frequency", [4096.0, 5000.0])
def test_a_resonance_beyond_half_the_rate_is_refused(frequency):
    layer = Impulses(40.0, 2.0, 0.7, (Resonance(frequency, 0.1),))
    with pytest.raises(
        InvalidParameter, match=rf"impulse resonance = {frequency} Hz; allowed: from 0 to below 4096 Hz"
    ):
        impulses(np.random.default_rng(1), layer, 64, RATE)


def test_pink_noise_that_begins_beyond_half_the_rate_is_refused():
    with pytest.raises(InvalidParameter, match=r"pink lowest frequency = 4096\.0 Hz; allowed: from 0 to below 4096 Hz"):
        pink_noise(np.random.default_rng(1), PinkNoise(1.0, 4096.0), 64, RATE)
    with pytest.raises(InvalidParameter, match=r"pink lowest frequency = 5000\.0 Hz"):
        pink_density(PinkNoise(1.0, 5000.0), np.array([100.0]), RATE)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: white_noise(np.random.default_rng(1), -0.1, 4), r"white rms = -0\.1 m/s²; it must not be below 0"),
        (lambda: PinkNoise(-1.0), r"pink rms = -1\.0 m/s²"),
        (lambda: PinkNoise(1.0, 0.0), r"pink lowest frequency = 0\.0 Hz; it must be above 0"),
        (lambda: PinkNoise(1.0, 1.0, 4.0), r"pink slope = 4\.0; allowed: 0 to 3"),
        (lambda: ShaftHarmonics((1.0, -1.0)), r"shaft harmonic amplitude = -1\.0 m/s²"),
        (lambda: ShaftHarmonics((1.0,), 1001), "first order = 1001; allowed: whole numbers 1 to 1000"),
        (lambda: ShaftHarmonics((1.0,), 0), "first order = 0; allowed: whole numbers 1 to 1000"),
        (lambda: GearMesh(0, (1.0,)), "teeth = 0; allowed: whole numbers 1 to 1000"),
        (lambda: GearMesh(9, (1.0,), modulation=1.2), r"modulation = 1\.2; allowed: 0 to 1"),
        (lambda: GearMesh(1001, (1.0,)), "teeth = 1001; allowed: whole numbers 1 to 1000"),
        (lambda: GearMesh(9, (1.0,), 1001), "other teeth = 1001; allowed: whole numbers 0 to 1000"),
        (lambda: GearMesh(9, (1.0,), other_modulation=1.2), r"other modulation = 1\.2; allowed: 0 to 1"),
        (lambda: GearMesh(9, (1.0,), sidebands=51), "sidebands = 51; allowed: whole numbers 0 to 50"),
        (lambda: GearMesh(9, (1.0, -1.0)), r"mesh amplitude = -1\.0 m/s²"),
        (lambda: MainsHum(0.0, ()), r"mains frequency = 0\.0 Hz; it must be above 0"),
        (lambda: MainsHum(50.0, (1.0, -1.0)), r"hum amplitude = -1\.0 m/s²"),
        (lambda: Impulses(-1.0, 1.0, 0.5, (Resonance(5.0, 0.1),)), r"impulses per second = -1\.0; allowed: 0 to 10000"),
        (lambda: Impulses(10001.0, 1.0, 0.5, (Resonance(5.0, 0.1),)), r"impulses per second = 10001\.0; allowed: 0 to"),
        (lambda: Impulses(1.0, 1.0, 5.1, (Resonance(5.0, 0.1),)), r"impulse spread = 5\.1; allowed: 0 to 5"),
        (lambda: Impulses(1.0, -1.0, 0.5, (Resonance(5.0, 0.1),)), r"impulse amplitude = -1\.0 m/s²"),
        (lambda: Impulses(1.0, 1.0, 0.5, ()), "impulses have no resonance to ring"),
        (lambda: Resonance(0.0, 0.1), r"impulse resonance = 0\.0 Hz; it must be above 0"),
        (lambda: Resonance(5.0, 0.71), r"impulse damping = 0\.71; allowed: above 0, up to 0\.7"),
        (lambda: Resonance(5.0, 0.0), r"impulse damping = 0\.0; allowed: above 0, up to 0\.7"),
    ],
)
def test_an_impossible_layer_is_refused_with_its_number(make, message):
    with pytest.raises(InvalidParameter, match=message):
        make()


def test_stretches_of_a_recording_start_anywhere_that_fits():
    generator = np.random.default_rng(10)
    starts = np.array([draw_starts(generator, 12, 10) for _ in range(200)])
    assert {tuple(pair) for pair in starts.tolist()} == {(first, second) for first in range(3) for second in range(3)}
    assert draw_starts(generator, 10, 10) == (0, 0)


def test_a_recording_shorter_than_the_record_is_refused_and_not_repeated():
    with pytest.raises(InvalidParameter, match="the recording holds 9 samples; a record needs 10"):
        draw_starts(np.random.default_rng(1), 9, 10)


@pytest.mark.parametrize(
    "build",
    [
        lambda sequence: SensorChain(sequence([SensorMode(900.0, 0.1)])),
        lambda sequence: Impulses(1.0, 0.1, 0.5, sequence([Resonance(900.0, 0.1)])),
        lambda sequence: GearMesh(20, sequence([1.0, 0.5])),
        lambda sequence: ShaftHarmonics(sequence([1.0, 0.5])),
        lambda sequence: MainsHum(50.0, sequence([1.0, 0.5])),
    ],
    ids=["chain", "impulses", "gear mesh", "shaft harmonics", "hum"],
)
def test_layers_that_lists_describe_are_those_of_tuples(build):
    assert build(list) == build(tuple)
    assert hash(build(list)) == hash(build(tuple))

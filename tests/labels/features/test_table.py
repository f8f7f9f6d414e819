"""The feature table: named, documented, blind to scale, nearly blind to rate, and pointing at the right race."""

from pathlib import Path

import numpy as np
import pytest

from labels.band_tree import COMMON_BANDWIDTH
from labels.features.analysis import analyse
from labels.features.kinematics import bearing_kinematics
from labels.features.table import FEATURE_NAMES, FEATURES, feature_values

KNOWN = bearing_kinematics(9, 39.04e-3, 7.94e-3, 0.0, 25.0)


def features(signal, rate, kinematics, bandwidth=COMMON_BANDWIDTH):
    return feature_values(analyse(signal, rate, kinematics, bandwidth))


def named(values):
    return dict(zip(FEATURE_NAMES, values, strict=True))


def test_every_feature_has_one_name_a_dimension_a_sentence_and_a_source():
    assert len(set(FEATURE_NAMES)) == len(FEATURES)
    for feature in FEATURES:
        assert feature.sentence.endswith(".")
        assert feature.source
        assert feature.dimension


def test_features_do_not_see_the_scale(impulse_train):
    signal = impulse_train(KNOWN.bpfo)
    # Only rounding differs.
    np.testing.assert_allclose(
        features(1e-3 * signal, 20_000.0, KNOWN), features(signal, 20_000.0, KNOWN), rtol=1e-6, atol=1e-9
    )


@pytest.mark.parametrize(("race", "other"), [("outer", "inner"), ("inner", "outer")])
@pytest.mark.parametrize(("rate", "duration"), [(10_000.0, 4.0), (20_000.0, 0.4), (97_656.0, 1.0)])
def test_the_race_shows_at_any_rate_and_length(impulse_train, race, other, rate, duration):
    # Three BPFO of KNOWN are 0.7 % less than two BPFI, which lends the inner race lines of the outer one; not so here.
    apart = bearing_kinematics(9, 39.04e-3, 11.0e-3, 0.0, 25.0)
    for known, lead in ((apart, 0.5), (KNOWN, 0.25)):
        order = known.bpfo if race == "outer" else known.bpfi
        found = named(features(impulse_train(order, rate, duration), rate, known))
        assert found[f"{race}_evidence"] > found[f"{other}_evidence"] + lead
        assert found[f"{race}_strength"] > found[f"{other}_strength"]


def test_the_race_shows_with_a_speed_that_is_two_percent_off_and_two_percent_slip(impulse_train):
    off = KNOWN.at(25.0 * 1.02)
    slipping = 9 * KNOWN.ftf * 0.98
    turning = impulse_train(slipping, modulation=0.5)
    assert named(features(turning, 20_000.0, off))["race_evidence"] > 0.5


def test_a_record_limited_to_a_common_bandwidth_has_nearly_the_features_of_one_sampled_slowly(impulse_train):
    fast = impulse_train(KNOWN.bpfo, 40_000.0, 1.0, snr_db=10.0)
    spectrum = np.fft.rfft(fast)
    slow = np.fft.irfft(spectrum[: spectrum.size // 4 + 1], 10_000)
    one, two = (named(features(signal, rate, KNOWN, 4000.0)) for signal, rate in ((fast, 40_000.0), (slow, 10_000.0)))
    for name in ("outer_evidence", "outer_strength", "race_evidence", "kurtosis", "outer_cepstrum"):
        # The same components, on arrays of other lengths: bands end one component apart.
        assert one[name] == pytest.approx(two[name], abs=0.05), name


def test_the_speed_is_refined_from_harmonics_of_the_shaft():
    generator = np.random.default_rng(6)
    rate, shaft = 20_000.0, 25.37
    time = np.arange(40_000) / rate
    signal = generator.standard_normal(time.size)
    for k in range(1, 7):
        signal += 0.3 * np.cos(2.0 * np.pi * k * shaft * time + k)
    speed = analyse(signal, rate, KNOWN).speed
    # The sixth harmonic is read to a component of 0.5 Hz, so the shaft to 0.5 / 6 / 2 Hz: 0.17 %.
    assert speed.shaft_hz == pytest.approx(shaft, rel=2e-3)
    assert speed.evidence > 30.0


def test_noise_shows_no_race():
    table = [features(np.random.default_rng(seed).standard_normal(20_000), 20_000.0, KNOWN) for seed in range(8)]
    evidence = np.array(table)[:, FEATURE_NAMES.index("outer_evidence")]
    assert np.median(evidence) < 2.0  # ln(1 + nats): faults in noise of equal power give 5 to 9


def test_the_page_of_features_is_written_from_the_table():
    page = (Path(__file__).parents[3] / "docs" / "features.md").read_text(encoding="utf-8")
    for feature in FEATURES:
        assert f"| `{feature.name}` | {feature.dimension} | {feature.sentence} |" in page


def test_a_sensor_mounted_the_other_way_round_gives_the_same_features(impulse_train):
    generator = np.random.default_rng(3)
    skewed = impulse_train(KNOWN.bpfo) + generator.exponential(1.0, 20_000)
    values = features(skewed, 20_000.0, KNOWN)
    assert named(values)["skewness"] > 0.3  # an exponential has 2, in a sum of three parts of like size
    np.testing.assert_allclose(features(-skewed, 20_000.0, KNOWN), values, rtol=1e-9, atol=1e-12)  # rounding


def test_the_narrowest_band_holds_three_harmonics_of_either_race():
    for shaft_hz in (25.0, 75.0):
        analysis = analyse(np.random.default_rng(0).standard_normal(20_000), 20_000.0, KNOWN.at(shaft_hz))
        widths = np.diff(analysis.envelopes.edges[1:], axis=1) * analysis.record.bandwidth
        assert widths.min() >= 3.0 * KNOWN.bpfi * shaft_hz
    assert 0.5 * widths.min() < 3.5 * KNOWN.bpfi * shaft_hz  # half as wide they would be too narrow


def test_a_line_of_the_bearing_is_no_decoy():
    # Eight balls of 0.2825 of the pitch diameter pass the outer race at 2.87 orders, which other bearings have not.
    own = bearing_kinematics(8, 1.0, 0.2825, 0.0, 25.0)
    turn = 2.0 * np.pi * 25.0 * np.arange(100_000) / 20_000.0
    noises = [np.random.default_rng(seed).standard_normal(100_000) for seed in range(8)]
    signals = [np.sqrt(1.0 + 0.6 * np.cos(2.87 * turn)) * noise for noise in noises]
    # One draw of noise alone may make up to 2.7.
    assert np.median([named(features(signal, 20_000.0, own))["largest_decoy"] for signal in signals]) < 2.0
    assert min(named(features(signal, 20_000.0, KNOWN))["largest_decoy"] for signal in signals) > 3.0

"""Records that give no rows, or rows of some of their pieces only."""

import math
from functools import partial
from types import SimpleNamespace

import numpy as np
import pandas
import pytest

from datagen.benchmark.corpus_rows import read_rows
from datagen.benchmark.fitness import TOO_FAST, TOO_SHORT
from datagen.benchmark.reading_policy import Reading
from datagen.benchmark.record_rows import (
    RecordFacts,
    RecordRows,
    Row,
    feature_rows,
    piece_count,
    record_rows,
    signal_rows,
)
from datagen.benchmark.windows import common_rate, read_windows
from datagen.corpus import Corpus
from datagen.errors import BadInput
from datagen.judging.known import known_kinematics
from labels.classifier.liveness import DEAD, STOPPED, liveness, recorder_step
from labels.features.analysis import analyse
from labels.features.table import FEATURE_NAMES
from labels.features.turning import Turning

RATE = 12_000.0


def labels(**changes):
    """What the labels say of a small bearing at 30 Hz."""
    known = {"balls": 9, "pitch_diameter": 39.04e-3, "ball_diameter": 7.94e-3, "contact_angle": 0.0}
    named = {"bearing_id": "b", "recording": "r", "record": 1, "rate_hz": RATE, "speed_rpm": 1800.0}
    return pandas.Series(named | known | changes)


def shaking(size):
    """White noise of a machine that shakes."""
    return np.random.default_rng(size).standard_normal((size, 1))


def turning_at(rpm, seconds):
    """The same with four lines of the shaft."""
    turns = rpm / 60.0 * np.arange(int(seconds * RATE)) / RATE
    lines = sum(np.cos(2.0 * np.pi * harmonic * turns) for harmonic in range(1, 5))
    return shaking(turns.size) + lines[:, None]


@pytest.mark.parametrize("size", [16, 63, 1199])
@pytest.mark.parametrize("reading", [Reading(), Reading(copies_db=(-18.0, 12.0)), Reading(noise_db=-10.0)])
def test_a_record_of_few_samples_is_rejected_with_its_reason(size, reading):
    assert record_rows(shaking(size), labels(), reading) == RecordRows([], RecordFacts(TOO_SHORT))


@pytest.mark.parametrize("size", [64, 65, 97, 200, 499])
def test_stretches_of_few_samples_have_finite_features(size):
    kinematics = known_kinematics(labels())
    rows = signal_rows(shaking(size)[:, 0], RATE, kinematics, Reading(copies_db=(-18.0, 12.0)), [1])
    assert np.isfinite([row.values for row in rows]).all()
    assert rows


def test_a_window_without_signal_leaves_the_vote_to_the_others():
    signal = shaking(3000)
    signal[1000:2000] = signal[1000]
    found = record_rows(signal, labels(), Reading(window=1000 / RATE))
    assert (len(found.rows), found.facts.reason) == (2, "")
    assert record_rows(np.full((3000, 1), 2.5), labels(), Reading(window=1000 / RATE)) == RecordRows(
        [], RecordFacts(DEAD)
    )


@pytest.mark.parametrize(("seconds", "pieces"), [(0.3, 1), (10.0, 1), (10.4, 1), (10.6, 2), (20.0, 2), (20.6, 3)])
def test_windows_are_hardly_longer_than_the_longest(seconds, pieces):
    assert piece_count(round(seconds * RATE), RATE, 10.0) == pieces


def test_axes_that_hear_the_same_are_trained_in_noise_of_their_own():
    found = record_rows(np.repeat(shaking(6000), 2, axis=1), labels(), Reading(copies_db=(-18.0, 12.0)))
    clean, noisy = ([row.values for row in found.rows if row.noisy == wanted] for wanted in (False, True))
    np.testing.assert_array_equal(clean[0], clean[1])
    assert not np.array_equal(noisy[0], noisy[len(noisy) // 2])


def test_an_axis_without_signal_leaves_the_vote_to_the_others():
    found = record_rows(np.hstack([np.zeros((3000, 1)), shaking(3000)]), labels(), Reading())
    assert ([row.axis for row in found.rows], found.facts.reason) == ([1], "")


@pytest.mark.parametrize("off", [0.0, 0.03, -0.03])
@pytest.mark.parametrize(
    ("speed_rpm", "hidden"),
    [
        (3010.0, ("outer",)),  # 3.585 orders are 179.84 Hz, beside three times 60 Hz
        (2980.0, ("outer",)),  # 178.05 Hz, which 0.7 % of slip may bring within 0.8 Hz and a component's breadth of it
        (2965.0, ()),  # 177.15 Hz, which it may not; 267.6 Hz of the inner race
        (2770.0, ("inner",)),  # 5.415 orders are 250.0 Hz; 165.5 Hz of the outer race
    ],
)
def test_a_race_whose_ball_passes_fall_on_the_mains_at_the_speed_found_is_told(speed_rpm, hidden, off):
    stated = labels(speed_rpm=speed_rpm * (1.0 + off), speed_basis="nominal" if off else "measured")
    found = record_rows(turning_at(speed_rpm, 4.0), stated, Reading())
    assert found.facts.found_rpm == pytest.approx(speed_rpm, rel=1e-3)
    assert found.facts.in_mains == hidden


@pytest.mark.parametrize(
    ("ball_diameter", "hidden"),
    [
        (8.5e-3, ("outer", "inner")),  # 3 and 5 orders exactly
        (8.54e-3, ("outer", "inner")),  # 2.9953 and 5.0047: the fourth line is 0.019 orders off, of 0.025
        (8.56e-3, ()),  # 2.9929 and 5.0071: the fourth line is 0.028 orders off
    ],
)
def test_a_race_whose_ball_passes_fall_on_the_shaft_is_told(ball_diameter, hidden):
    geometry = labels(balls=8, pitch_diameter=34e-3, ball_diameter=ball_diameter)
    assert record_rows(shaking(int(4 * RATE)), geometry, Reading()).facts.in_shaft == hidden


@pytest.mark.parametrize(
    ("speed_rpm", "bands"),
    [(0.99, 15), (1.01, 7), (1.99, 7), (2.01, 3), (3.99, 3), (4.01, 1)],
)
def test_bands_that_ball_passes_leave_no_room_for_are_not_counted(speed_rpm, bands):
    """Each holds three and a half times BPFI, with 9 balls 5.415 a turn; the least of so many is an eighth, a quarter,
    a half of what is looked at."""
    eighth = 0.95 * RATE / 2.0 / 8.0
    speed = speed_rpm * 60.0 * eighth / (3.5 * 5.4152)
    facts = record_rows(shaking(int(2 * RATE)), labels(speed_rpm=speed), Reading()).facts
    assert facts.bands == bands


def test_over_the_angle_of_a_changing_shaft_nothing_falls_on_the_mains():
    time = np.arange(int(4 * RATE)) / RATE
    turning = Turning(2.0 * np.pi * (45.0 * time + 1.3 * time**2))
    found = record_rows(shaking(time.size), labels(speed_rpm=3010.0), Reading(), turning)
    assert found.rows
    assert found.facts.in_mains == ()


@pytest.mark.parametrize(
    ("stated", "basis", "far"),
    [(1800.0, "measured", False), (1765.0, "measured", True), (1836.0, "measured", True), (1836.0, "nominal", False)],
)
def test_a_shaft_far_from_its_stated_speed_is_told(stated, basis, far):
    time = np.arange(int(4 * RATE)) / RATE
    # A spall of the outer race at 1800 rpm: one click every 1/107.5 s, that rings at 3 kHz.
    age = time % (1.0 / (30.0 * 3.5848))
    shaft = sum(np.sin(2.0 * np.pi * 30.0 * k * time) for k in (1, 2, 3))
    clicks = 8.0 * np.exp(-800.0 * age) * np.sin(2.0 * np.pi * 3000.0 * age)
    signal = shaking(time.size) + (shaft + clicks)[:, None]
    found = record_rows(signal, labels(speed_rpm=stated, speed_basis=basis), Reading())
    assert found.facts.found_rpm == pytest.approx(1800.0, rel=2e-3)
    assert found.facts.far_from_stated is far


def test_rows_tell_the_axis_that_they_are_of():
    found = record_rows(np.column_stack([shaking(3000), shaking(3001)[1:]]), labels(), Reading(window=1500 / RATE))
    assert [(row.axis, row.window) for row in found.rows] == [(0, 0), (0, 1), (1, 0), (1, 1)]


def test_each_record_has_noise_of_its_own_and_the_same_whenever_it_is_read():
    signal, noisy = shaking(3000), Reading(noise_db=-10.0)
    others = ({}, {}, {"record": 2}, {"recording": "s"}, {"bearing_id": "c"})
    first, again, *rest = (tuple(record_rows(signal, labels(**own), noisy).rows[0].values) for own in others)
    assert first == again
    assert len({first, *rest}) == 4


def test_each_window_of_a_record_has_its_own_part_of_a_changing_speed(monkeypatch):
    pieces = []

    def listening(piece, rate, given, bandwidth, turning):
        pieces.append((piece.size, turning.revolutions))
        return analyse(piece, rate, given, bandwidth, turning)

    monkeypatch.setattr("datagen.benchmark.record_rows.analyse", listening)
    time = np.arange(12000) / RATE
    turning = Turning(2.0 * np.pi * (20.0 * time + 10.0 * time**2))
    assert len(record_rows(shaking(12000), labels(), Reading(window=0.5), turning).rows) == 2
    # From 20 turns a second to 30 and from there to 40.
    assert pieces == [(6000, pytest.approx(12.5, rel=1e-3)), (6000, pytest.approx(17.5, rel=1e-3))]


def test_a_record_that_begins_in_silence_is_heard():
    signal = np.concatenate([np.zeros((5000, 1)), shaking(7000)])
    found = record_rows(signal, labels(), Reading())
    assert (len(found.rows), found.facts.reason) == (1, "")


def test_glitches_are_counted_and_make_no_record_impulsive():
    signal = shaking(24_000)
    glitched = np.column_stack([signal[:, 0], signal[:, 0]])
    glitched[[5000, 15_000], 0], glitched[20_000, 1] = 20.0, -30.0
    clean, found = (record_rows(each, labels(), Reading()) for each in (signal, glitched))
    assert (clean.facts.glitches, found.facts.glitches) == (0, 3)
    column = FEATURE_NAMES.index("kurtosis")
    for row in found.rows:
        # Two glitches of 20 deviations among 24 000 samples would raise it by 1.7, lines over them hardly move it.
        assert row.values[column] == pytest.approx(clean.rows[0].values[column], abs=0.01)


def test_jumps_are_counted_and_change_no_feature_much():
    signal = shaking(24_000)[:, :1]
    jumped = signal + 8.0 * (np.arange(24_000) >= 10_000)[:, None]
    clean, found = (record_rows(each, labels(), Reading()) for each in (signal, jumped))
    assert (clean.facts.jumps, found.facts.jumps) == (0, 1)
    assert found.rows[0].values == pytest.approx(clean.rows[0].values, abs=0.2)


def test_a_shock_is_counted_and_hides_no_modulation():
    """A machine that shakes harder at each passing ball shows it with a shock of 300 times its RMS too."""
    time, bpfo_hz = np.arange(24_000) / RATE, known_kinematics(labels()).bpfo * 30.0
    signal = shaking(24_000)[:, 0] * (1.0 + 0.7 * np.cos(2.0 * np.pi * bpfo_hz * time))
    since = np.maximum(time - 0.75, 0.0)
    shocked = signal + 300.0 * signal.std() * np.exp(-400.0 * since) * np.sin(2.0 * np.pi * 2500.0 * since)
    clean, found = (record_rows(each[:, None], labels(), Reading()) for each in (signal, shocked))
    assert (clean.facts.shocks, found.facts.shocks) == (0, 1)
    column = FEATURE_NAMES.index("outer_strength")
    assert found.rows[0].values[column] == pytest.approx(clean.rows[0].values[column], abs=0.2)


def test_a_bias_that_jumps_hides_no_modulation():
    time, bpfo_hz = np.arange(24_000) / RATE, known_kinematics(labels()).bpfo * 30.0
    signal = shaking(24_000)[:, 0] * (1.0 + 0.7 * np.cos(2.0 * np.pi * bpfo_hz * time))
    clean, found = (
        record_rows(each[:, None], labels(), Reading())
        for each in (signal, signal + 30.0 * signal.std() * (time > 1.0))
    )
    column = FEATURE_NAMES.index("outer_strength")
    assert found.rows[0].values[column] == pytest.approx(clean.rows[0].values[column], abs=0.05)


READERS = pytest.mark.parametrize(
    "read",
    [partial(read_rows, reading=Reading(), workers=1), partial(read_windows, rate=RATE)],
    ids=["rows", "windows"],
)


@READERS
def test_a_record_that_cannot_be_read_leaves_no_file_open(read, tiny_corpus, monkeypatch):
    closed = []
    monkeypatch.setattr(Corpus, "close", lambda corpus: closed.append(corpus.folder))
    with pytest.raises(BadInput):
        read(tiny_corpus, np.array([99]))
    assert closed == [tiny_corpus]


@READERS
def test_progress_counts_the_records_that_are_read(read, tiny_corpus):
    told = []
    wanted = np.array([2, 0, 5])
    read(tiny_corpus, wanted, count=lambda *counted: told.append(counted))
    assert told == sorted(set(told))
    assert told[-1] == (3, 3)


@pytest.mark.parametrize("level", [-10.0, 0.0, 20.0])
def test_noise_added_has_the_level_asked_for(level, monkeypatch):
    heard = []

    def listening(piece, *others):
        heard.append(piece)
        return analyse(piece, *others)

    monkeypatch.setattr("datagen.benchmark.record_rows.analyse", listening)
    signal = 3.0 * np.random.default_rng(0).standard_normal(50_000)
    signal_rows(signal, RATE, known_kinematics(labels()), Reading(noise_db=level), [0])
    (piece,) = heard
    # The deviation of 50 000 draws is known to 0.3 %, 0.03 dB.
    assert 20.0 * math.log10(signal.std() / (piece - signal[: piece.size]).std()) == pytest.approx(level, abs=0.1)


def test_the_speed_told_in_training_is_off_by_up_to_its_share_either_way(monkeypatch):
    speeds = []

    def listening(piece, rate, given, *others):
        speeds.append(given.shaft_hz)
        return analyse(piece, rate, given, *others)

    monkeypatch.setattr("datagen.benchmark.record_rows.analyse", listening)
    known = known_kinematics(labels())
    for seed in range(60):
        signal_rows(shaking(1200)[:, 0], RATE, known, Reading(speed_error=0.02), [seed])
    share = np.array(speeds) / 30.0 - 1.0
    # Of 60 even draws from −2 to 2 % the outermost lie beyond 1.5 % on either side but in one case of 3000.
    assert -0.02 <= share.min() < -0.015
    assert 0.015 < share.max() <= 0.02


def test_the_windows_of_corpora_have_the_lowest_rate_of_all(monkeypatch):
    rates = {"one": [50_000.0, 20_000.0], "other": [12_000.0, 30_000.0]}
    monkeypatch.setattr(
        "datagen.benchmark.windows.Corpus",
        lambda folder: SimpleNamespace(labels=pandas.DataFrame({"rate_hz": rates[folder]})),
    )
    assert common_rate(["one", "other"], 10_000.0) == 12_000.0
    assert common_rate(["one"], 10_000.0) == 20_000.0
    assert common_rate(["one"], 5000.0) == 10_000.0


@pytest.mark.parametrize(("glitches", "drawn_over"), [(40, 40), (80, 0)])
def test_what_comes_oftener_than_once_a_turn_is_no_glitch(glitches, drawn_over):
    signal = shaking(24_000)  # two seconds, 60 turns
    signal[150 + 290 * np.arange(glitches)] = 30.0
    assert record_rows(signal, labels(), Reading()).facts.glitches == drawn_over


def test_the_speed_that_was_found_is_told_and_not_the_nominal_one():
    time = np.arange(48_000) / RATE
    signal = shaking(48_000)[:, 0] + sum(np.sin(2.0 * np.pi * 29.1 * k * time) for k in (1, 2, 3))
    found = record_rows(signal[:, None], labels(speed_basis="nominal"), Reading(copies_db=(-18.0, 12.0)))
    assert found.facts.found_rpm == pytest.approx(60.0 * 29.1, rel=1e-3)
    assert record_rows(shaking(16), labels(), Reading()).facts.found_rpm is None


def test_the_speed_that_is_told_is_the_median_of_the_rows_without_added_noise(monkeypatch):
    found = [(29.0, False), (30.0, False), (35.0, False), (31.0, True), (33.0, True), (34.0, True)]
    rows = [Row(np.zeros(len(FEATURE_NAMES)), noisy, "", shaft_hz=hz) for hz, noisy in found]
    monkeypatch.setattr("datagen.benchmark.record_rows.signal_rows", lambda *_: rows)
    assert record_rows(shaking(3000), labels(), Reading()).facts.found_rpm == pytest.approx(1800.0, rel=1e-12)


def test_a_stretch_of_a_record_has_the_part_of_a_changing_speed_that_was_heard_in_it(monkeypatch):
    """The angle itself is what is heard, so that a stretch tells where it was cut out."""
    time = np.arange(12_000) / RATE
    angle, apart = 2.0 * np.pi * (20.0 * time + 10.0 * time**2), []

    def listening(piece, rate, given, bandwidth, turning):
        apart.append((piece.size, np.abs(piece - turning.angle).max()))
        return analyse(piece, rate, given, bandwidth, turning)

    monkeypatch.setattr("datagen.benchmark.record_rows.analyse", listening)
    reading = Reading(copies_db=(140.0, 140.0))  # noise of 1e-7 of the signal's deviation of 60 rad
    assert len(signal_rows(angle, RATE, known_kinematics(labels()), reading, [3], Turning(angle))) == 3
    assert [size for size, _ in apart[:2]] == [12_000] * 2
    assert apart[2][0] < 12_000
    assert max(far for _, far in apart) < 1e-3


def test_components_of_windows_are_too_far_apart_to_tell_mains_where_these_are_short():
    """At 3010 rpm balls pass the outer race at three times 60 Hz; half a second has components 2 Hz apart."""
    signal = turning_at(3010.0, 4.0)
    assert record_rows(signal, labels(speed_rpm=3010.0), Reading(window=4.0)).facts.in_mains == ("outer",)
    assert record_rows(signal, labels(speed_rpm=3010.0), Reading(window=0.5)).facts.in_mains == ()


def test_copies_with_noise_have_no_steps_of_the_recorder(monkeypatch):
    steps = []

    def listening(analysis, piece, step):
        steps.append(step)
        return liveness(analysis, piece, step)

    monkeypatch.setattr("datagen.benchmark.record_rows.liveness", listening)
    coarse = np.round(shaking(3000)[:, 0], 1)
    reading = Reading(copies_db=(12.0, 12.0))
    signal_rows(coarse, RATE, known_kinematics(labels()), reading, [1], step=0.1)
    assert steps[0] == 0.1
    assert len(steps) == reading.copies
    assert max(steps[1:]) < 1e-3


def test_a_dead_axis_stays_dead_whatever_noise_is_added():
    three_values = np.random.default_rng(1).integers(0, 3, 3000).astype(float)
    assert signal_rows(three_values, RATE, known_kinematics(labels()), Reading(noise_db=0.0), [0]) == []


def test_a_window_that_lives_only_in_samples_that_no_transform_takes_is_none():
    """The last 55 of 1999 samples are dropped, as 1944 have a fast transform."""
    signal = np.append(np.full(1950, 2.5), np.arange(49.0))
    assert signal_rows(signal, RATE, known_kinematics(labels()), Reading(), [0]) == []


def test_a_record_too_fast_for_the_bandwidth_asked_for_is_rejected():
    # Balls pass the inner race at 162 Hz, which an envelope of 300 Hz does not show.
    assert record_rows(shaking(3000), labels(), Reading(bandwidth=300.0)).facts.reason == TOO_FAST
    assert record_rows(shaking(3000), labels(), Reading()).facts.reason == ""


@pytest.mark.parametrize(("silent", "reason"), [((0,), ""), ((0, 1), STOPPED)])
def test_a_record_is_rejected_where_all_its_rows_are(silent, reason, monkeypatch):
    def row(axis):
        return Row(np.zeros(len(FEATURE_NAMES)), False, STOPPED if axis in silent else "", shaft_hz=30.0)

    monkeypatch.setattr("datagen.benchmark.record_rows.signal_rows", lambda *given: [row(given[4][-1])])
    found = record_rows(np.hstack([shaking(3000), shaking(3000)]), labels(), Reading())
    assert (len(found.rows), found.facts.reason) == (2, reason)


def test_rows_stand_in_the_table_as_they_were_found():
    values = np.arange(3.0 * len(FEATURE_NAMES)).reshape(3, -1)
    found = [Row(values[0], False, "", axis=0), Row(values[1], True, "", axis=2), Row(values[2], True, "", axis=1)]
    table = feature_rows(found, 7)
    assert table.table.tolist() == values.tolist()
    assert (table.record.tolist(), table.axis.tolist()) == ([7, 7, 7], [0, 2, 1])
    assert table.noisy.tolist() == [False, True, True]
    assert feature_rows([], 7).table.shape == (0, len(FEATURE_NAMES))


def test_each_window_is_heard_below_its_own_bandwidth_and_judged_alive_by_its_own_samples(monkeypatch):
    heard, judged = [], []

    def listening(piece, rate, given, bandwidth, turning):
        heard.append((piece.size, bandwidth))
        return analyse(piece, rate, given, bandwidth, turning)

    def judging(analysis, piece, step):
        judged.append(piece.size)
        return liveness(analysis, piece, step)

    monkeypatch.setattr("datagen.benchmark.record_rows.analyse", listening)
    monkeypatch.setattr("datagen.benchmark.record_rows.liveness", judging)
    reading = Reading(window=1000 / RATE, lowest_bandwidth=3000.0)
    signal_rows(shaking(5000)[:, 0], RATE, known_kinematics(labels()), reading, [0])
    assert [size for size, _ in heard] == judged == [1000] * 5
    drawn = [bandwidth for _, bandwidth in heard]
    assert len(set(drawn)) == 5
    assert 3000.0 <= min(drawn) < max(drawn) <= 6000.0


@pytest.mark.parametrize("glitch", [0.0, 2000.0])
def test_a_stopped_machine_is_known_by_its_recorders_step_also_if_a_glitch_was_replaced(glitch):
    # White noise of one and a half steps, in a unit misread a hundredfold: too loud for the limit of velocity.
    digits = np.round(1.5 * shaking(24_000))
    digits[10_000] += glitch
    found = record_rows(digits * 10.0, labels(), Reading())
    assert found.facts.glitches == (glitch > 0.0)
    assert found.facts.reason == STOPPED
    heard = signal_rows(10.0 * digits[:, 0], RATE, known_kinematics(labels()), Reading(noise_db=-20.0), [0], None, 10.0)
    assert [row.reason for row in heard] == [""]


def test_a_signal_of_one_value_has_no_step():
    assert recorder_step(np.full(9, 2.0)) == math.inf
    assert recorder_step(np.array([3.0, 1.0, 1.25, 3.0])) == 0.25


def test_of_axes_rejected_for_different_reasons_the_first_is_told(monkeypatch):
    reasons = [STOPPED, "another"]
    monkeypatch.setattr(
        "datagen.benchmark.record_rows.signal_rows",
        lambda *given: [Row(np.zeros(len(FEATURE_NAMES)), False, reasons[given[4][-1]], shaft_hz=30.0)],
    )
    assert record_rows(np.hstack([shaking(3000), shaking(3000)]), labels(), Reading()).facts.reason == STOPPED

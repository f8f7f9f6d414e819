"""What the calibration is fitted to: the noise of the records, and which pairs of candidates are their events."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from datagen.sizing.sized_records import SizedRecord
from datagen.sizing.training_rows import LAG_SCALE, LEVELS_DB, Excerpt, _excerpts, in_noise_of_the_ladder, trial
from labels.spall_size.estimation.gathering import gather_evidence
from labels.spall_size.event_truth import EventTruth
from labels.spall_size.events.evidence import Evidence
from labels.spall_size.situation import Situation

Array = NDArray[np.float64]

RATE = 65536.0
LAG = 100.0 / RATE
MACHINE = Situation(12, 2, 38.75e-3, 7.12e-3, 2.0 * math.pi * 30.0)
SPACING = math.pi / 6.0  # of twelve balls


def test_records_are_heard_in_noise_of_the_levels_of_the_ladder() -> None:
    clean = 3.0 * np.random.default_rng(0).standard_normal(20_000)
    ratios = [clean.std() / (in_noise_of_the_ladder(clean, record) - clean).std() for record in range(40)]
    levels = np.array([20.0 * math.log10(ratio) for ratio in ratios])
    nearest = np.abs(levels[:, None] - np.array(LEVELS_DB)).argmin(axis=1)
    # The deviation of 20 000 draws is known to 0.5 %, 0.04 dB.
    assert levels == pytest.approx(np.array(LEVELS_DB)[nearest], abs=0.2)
    assert set(nearest.tolist()) == set(range(len(LEVELS_DB)))


@pytest.fixture(scope="module")
def heard() -> tuple[Evidence, Array]:
    """Bursts of 6 kHz, two a pass of the outer race, LAG apart: what is heard, and when the first of each begin."""
    period = MACHINE.pass_periods()["outer"]
    time, first = np.arange(32768) / RATE, np.arange(0.001, 0.48, period)
    signal = 0.01 * np.random.default_rng(1).standard_normal(time.size)
    for start in first:
        for burst in (start, start + LAG):
            since = np.maximum(time - burst, 0.0)
            signal += np.exp(-since / 2e-4) * np.sin(2.0 * math.pi * 6000.0 * since)
    evidence = gather_evidence(signal, RATE, MACHINE.pass_periods())
    assert evidence is not None
    assert evidence.race == "outer"
    return evidence, first


def record(first: Array, last: Array, extent: float) -> SizedRecord:
    """A record of a spall of this extent (rad) on the outer race, with its events at these times (K,), s."""
    labels = {"location": "outer", "extent": extent, "extent_spacing": extent / SPACING, "bearing_id": "b"}
    labels |= {"speed_rpm": 1800.0, "bpfo": MACHINE.bearing().bpfo}
    truth = EventTruth(first, last, np.zeros(first.size, dtype=np.bool_))
    return SizedRecord(0, RATE, np.zeros((32768, 2)), None, labels, MACHINE, truth)


@pytest.mark.parametrize("spacings", [0, 1])
def test_whole_passes_are_taken_off_the_lag_and_as_many_spacings_off_the_arc(
    spacings: int, heard: tuple[Evidence, Array]
) -> None:
    # A ball covers a spacing in a pass, so a spall a spacing longer shows its exit a pass later.
    (evidence, first), whole = heard, Excerpt(np.zeros(32768), 0, True, True)
    late = LAG + spacings * MACHINE.pass_periods()["outer"]
    made = trial(record(first, first + late, 0.2 + spacings * SPACING), evidence, whole)
    assert made.true_lag == pytest.approx(late * RATE)
    assert made.lag == pytest.approx(LAG * RATE, abs=0.5)  # the period that was tracked is a fraction of a sample off
    assert made.arc == pytest.approx(0.2)
    assert made.asked == (spacings == 0)  # beyond 0.9 spacings no size must be given


def test_the_pair_of_the_true_lag_at_the_true_place_is_the_best(heard: tuple[Evidence, Array]) -> None:
    (evidence, first), whole = heard, Excerpt(np.zeros(32768), 0, True, True)
    made = trial(record(first, first + LAG, 0.2), evidence, whole)
    best = int(made.quality.argmax())
    assert made.quality[best] > 0.9
    assert evidence.pairs.lag[best] == pytest.approx(LAG * RATE, rel=0.02)
    # Events of that lag half a pass away are none of the pairs that were heard.
    away = first[:-1] + 0.5 * MACHINE.pass_periods()["outer"]
    elsewhere = trial(record(away, away + LAG, 0.2), evidence, whole)
    assert elsewhere.lag == pytest.approx(made.lag)
    assert elsewhere.quality[best] == 0.0


@pytest.mark.parametrize(("off", "wrong"), [(0.4, 0.0), (4.5, 4.0)])  # samples
def test_half_a_sample_of_the_lag_is_no_error(off: float, wrong: float, heard: tuple[Evidence, Array]) -> None:
    (evidence, first), whole = heard, Excerpt(np.zeros(32768), 0, True, True)
    best = int(trial(record(first, first + LAG, 0.2), evidence, whole).quality.argmax())
    lag = float(evidence.pairs.lag[best]) - off
    made = trial(record(first, first + lag / RATE, 0.2), evidence, whole)
    assert made.quality[best] == pytest.approx(math.exp(-wrong / lag / LAG_SCALE), rel=1e-6)


@pytest.mark.parametrize("snr_db", [10.0, 60.0, math.nan])
def test_every_record_is_heard_as_stored_and_once_whole_without_noise(snr_db: float) -> None:
    noise, clean = np.random.default_rng(2).standard_normal((2, 4000, 2))
    noisy = snr_db == 10.0  # 60 dB and more count as none, and so does a record without background
    sized = record(np.zeros(0), np.zeros(0), 0.2)
    sized = replace(sized, clean=clean, acceleration=clean + 0.3 * noise * noisy, labels={"snr_db": snr_db})
    stored, other, part = _excerpts(sized)
    assert (stored.stored, other.stored, part.stored) == (True, False, False)
    assert (stored.clean, other.clean, part.clean) == (not noisy, noisy, False)
    np.testing.assert_array_equal(stored.signal, sized.acceleration[:, 1])
    (whole,) = (excerpt.signal for excerpt in (stored, other) if excerpt.clean)
    np.testing.assert_array_equal(whole, clean[:, 1])
    assert not np.array_equal(stored.signal, other.signal)
    assert 400 <= part.signal.size <= 2000  # a tenth to half
    assert any(
        np.array_equal(part.signal, one.signal[part.start : part.start + part.signal.size]) for one in (stored, other)
    )


def test_the_part_of_a_clean_record_is_heard_with_noise_as_often_as_without() -> None:
    clean = np.random.default_rng(3).standard_normal((4000, 2))
    sized = replace(record(np.zeros(0), np.zeros(0), 0.2), acceleration=clean, labels={"snr_db": math.nan})
    noisy = 0
    for number in range(64):
        part = _excerpts(replace(sized, labels=sized.labels | {"record": number}, record=number))[2]
        noisy += not np.array_equal(part.signal, clean[part.start : part.start + part.signal.size, 1])
    assert 16 < noisy < 48  # of 64 even draws, four deviations of 4 to either side


def test_the_truth_of_a_part_is_told_from_where_it_begins(heard: tuple[Evidence, Array]) -> None:
    """The same as of a whole record, though it begins in the middle of the sixth pass of a longer one, whose passes
    before that had another lag."""
    evidence, first = heard
    period = MACHINE.pass_periods()["outer"]
    start = round(5.5 * period * RATE)
    before, later = period * np.arange(0.1, 5.0), first + start / RATE
    longer = record(np.append(before, later), np.append(before + 0.5 * LAG, later + LAG), 0.2)
    made = trial(longer, evidence, Excerpt(np.zeros(32768), start, False, False))
    whole = trial(record(first, first + LAG, 0.2), evidence, Excerpt(np.zeros(32768), 0, True, True))
    assert made.true_lag == pytest.approx(LAG * RATE)
    np.testing.assert_allclose(made.quality, whole.quality, atol=1e-6)
    assert made.quality.max() > 0.9


def test_a_record_without_events_or_heard_on_the_wrong_race_has_no_pair_to_be_found(
    heard: tuple[Evidence, Array],
) -> None:
    (evidence, first), whole = heard, Excerpt(np.zeros(32768), 0, True, True)
    right = record(first, first + LAG, 0.2)
    for one in (replace(right, truth=None), replace(right, labels=right.labels | {"location": "inner", "bpfi": 7.0})):
        made = trial(one, evidence, whole)
        assert math.isnan(made.lag)
        assert math.isnan(made.arc)
        assert not made.quality.any()

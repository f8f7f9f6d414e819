"""Alarms that a stated share of healthy records pass, whether noise hides them or not."""

from dataclasses import replace

import numpy as np
import pytest

from labels.classifier.alarm import CLEAR, CLEARNESS, NOISE_LIKE, Alarm, clearness, fit_alarm
from labels.classifier.log_odds import logit, probability_of
from labels.classifier.rule import line_heights
from labels.classifier.votes import averaged, vote_shares
from labels.features.table import FEATURE_NAMES

ONE_AXIS = np.zeros(20_000, dtype=np.int64)


def rows(kurtosis):
    table = np.zeros((len(kurtosis), len(FEATURE_NAMES)))
    table[:, FEATURE_NAMES.index(CLEARNESS)] = kurtosis
    return table


def healthy(records, seed):
    """Two axes of each record, as they are and in noise: clear records look more like a spall than noise does."""
    generator = np.random.default_rng(seed)
    clear = np.repeat(generator.uniform(size=records) < 0.5, 2)
    level = np.repeat(generator.standard_normal(records), 2) + 2.0 * clear
    kurtosis = np.where(clear, 1.0, 0.0)
    level = np.concatenate([level, generator.standard_normal(2 * records)])
    probability = 1.0 / (1.0 + np.exp(-level))
    owner = np.tile(np.repeat(np.arange(records), 2), 2)
    return (
        probability,
        rows(np.concatenate([kurtosis, np.zeros(2 * records)])),
        owner,
        np.arange(4 * records) // 2 >= records,
    )


def alarming(alarm, probability, table, owner, noisy):
    """Share of records as they are whose mean logit passes that of the alarm."""
    margin = (logit(probability) - logit(alarm.at(table)))[~noisy]
    return np.mean([margin[owner[~noisy] == record].mean() > 0.0 for record in np.unique(owner)])


def test_a_row_is_as_clear_as_its_bands_differ_from_noise():
    middle = np.sqrt(NOISE_LIKE * CLEAR)  # halfway in logarithms
    np.testing.assert_allclose(
        clearness(rows([0.0, NOISE_LIKE, middle, CLEAR, 5.0])), [0.0, 0.0, 0.5, 1.0, 1.0], atol=1e-12
    )


def test_between_noise_and_a_clear_record_the_alarm_moves_in_logits():
    alarm = Alarm(0.5, 0.9)
    found = alarm.at(rows([0.0, np.sqrt(NOISE_LIKE * CLEAR), 1.0]))
    np.testing.assert_allclose(found, [0.5, 0.75, 0.9], rtol=1e-9)  # odds 1, 3, 9


def test_the_votes_of_several_axes_alone_have_to_pass_more_log_odds():
    alarm, table = Alarm(0.5, 0.9, several=float(np.log(3.0))), rows([0.0, 0.0, 1.0, 1.0])
    several = np.array([False, True, False, True])
    np.testing.assert_allclose(alarm.at(table, several), [0.5, 0.75, 0.9, 27.0 / 28.0], rtol=1e-9)  # odds 1, 3, 9, 27
    np.testing.assert_allclose(Alarm(0.5, 0.9).at(table, several), [0.5, 0.5, 0.9, 0.9], rtol=1e-9)


def test_the_share_asked_of_healthy_records_passes_the_alarm():
    given = healthy(2000, 1)
    alarm = fit_alarm(*given, ONE_AXIS[: given[0].size], 0.05)
    assert alarming(alarm, *given) == pytest.approx(0.05, abs=1e-3)  # one record in 2000 is a step of 5e-4
    # 5 % of 2000 other records scatter by half a percent; three times that.
    assert alarming(alarm, *healthy(2000, 2)) == pytest.approx(0.05, abs=0.015)


def test_noise_raises_half_of_the_alarms_and_needs_less_to_do_so():
    probability, table, owner, noisy = healthy(2000, 3)
    alarm = fit_alarm(probability, table, owner, noisy, ONE_AXIS[: owner.size], 0.05)
    hidden = clearness(table) == 0.0
    assert np.mean(probability[hidden] > alarm.in_noise) == pytest.approx(0.025, abs=1e-3)  # a quantile of its own rows
    assert alarm.in_noise < alarm.in_clear


def test_healthy_records_in_noise_alone_set_no_alarm():
    probability, table, owner, noisy = healthy(50, 5)
    with pytest.raises(ValueError, match="without added noise"):
        fit_alarm(probability[noisy], table[noisy], owner[noisy], noisy[noisy], ONE_AXIS[: noisy.sum()], 0.05)


def test_few_rows_like_noise_leave_one_alarm_for_all():
    probability, table, owner, noisy = healthy(2000, 4)
    clear = clearness(table) == 1.0
    alarm = fit_alarm(probability[clear], table[clear], owner[clear], noisy[clear], ONE_AXIS[: clear.sum()], 0.05)
    assert alarm.in_noise == pytest.approx(float(np.quantile(probability[clear], 0.975)))
    assert alarm.in_clear >= alarm.in_noise * (1.0 - 1e-9)  # up to rounding


@pytest.mark.parametrize(("share", "passing"), [(0.1, 4), (0.07, 2)])  # of 40 records: 2.8 are not 3
@pytest.mark.parametrize("kurtosis", [CLEAR, NOISE_LIKE**0.5 * CLEAR**0.5], ids=["clear", "half clear"])
def test_of_few_clear_records_exactly_the_share_passes_and_no_more(kurtosis, share, passing):
    level = np.concatenate([np.linspace(-3.0, 3.0, 40), np.linspace(-1.0, 0.0, 40)])
    noisy = np.arange(80) >= 40
    probability = 1.0 / (1.0 + np.exp(-level))
    table = rows(np.where(noisy, 0.0, kurtosis))
    alarm = fit_alarm(probability, table, np.arange(80) % 40, noisy, ONE_AXIS[:80], share)
    assert np.sum((level > logit(alarm.at(table)) + 1e-9) & ~noisy) == passing  # up to rounding


def test_lines_as_high_as_few_healthy_records_have_are_an_alarm_by_themselves():
    """A record's height is its rows' mean of the logarithm: of rows that stand 1 and 9 high it is 3."""
    probability, table, owner, noisy = healthy(1000, 6)
    height = np.random.default_rng(7).exponential(size=1000)
    column = FEATURE_NAMES.index("inner_strength")
    table[:, column] = height[owner] + np.tile([-1.0, 1.0], len(owner) // 2)
    table[noisy, column] += 100.0  # what noise was added to says nothing of it
    alarm = fit_alarm(probability, table, owner, noisy, ONE_AXIS[: owner.size], 0.05)
    assert np.mean(height > np.log(alarm.height)) == pytest.approx(0.02, abs=1e-3)  # one record is a step of 1e-3
    found = alarm.height * np.array([[0.99, 0.5], [0.5, 1.01], [np.nan, np.nan], [1.0, 0.5]])
    assert alarm.by_lines_alone(found).tolist() == [False, True, False, False]
    assert not Alarm(0.5, 0.9).by_lines_alone(found).any()


def test_a_vote_of_two_axes_passes_the_alarm_as_seldom_as_their_mean():
    probability, table, owner, noisy = healthy(4000, 8)
    generator = np.random.default_rng(9)
    probability = probability_of(logit(probability) + generator.standard_normal(probability.size))
    table[:, FEATURE_NAMES.index("outer_strength")] = generator.standard_normal(probability.size)
    axes = np.arange(probability.size) % 2
    alarm = fit_alarm(probability, table, owner, noisy, axes, 0.05)
    of_one = fit_alarm(probability, table, owner, noisy, ONE_AXIS[: owner.size], 0.05)
    assert of_one == replace(alarm, several=0.0, height_several=1.0)
    plain = ~noisy
    margin = (logit(probability) - logit(alarm.at(table, np.ones(noisy.size, dtype=bool))))[plain]
    shares = vote_shares(margin, owner[plain], axes[plain])
    votes = averaged(margin, owner[plain], np.arange(4000), shares)
    # 5 % of 4000 records; that the rise is taken from the highest fifth and not at the alarm itself moves 1 %.
    assert np.mean(votes > 0.0) == pytest.approx(0.05, abs=0.01)
    assert np.mean(votes + alarm.several > 0.0) > 0.065
    heights = line_heights(table[plain], owner[plain], np.arange(4000), axes[plain], alarm.height_several)
    assert np.mean(alarm.by_lines_alone(heights)) == pytest.approx(0.02, abs=0.006)
    assert np.mean(alarm.by_lines_alone(heights * alarm.height_several)) > 0.03


def test_how_much_a_vote_raises_is_taken_from_the_records_nearest_their_own_alarms():
    """Both axes of clear records say the same; those of records like noise are 6 apart, which raises a vote of 2 : 1
    above the mean by 1.

    Of 50 records the highest fifth are six clear ones, of which 10 % of 50 pass, and four like noise, 3 below theirs.
    """
    of_clear = np.array([8.0] * 5 + [7.9] + [0.0] * 34)
    level = np.concatenate([np.repeat(of_clear, 2), np.tile([-8.0, -2.0], 10)])
    table, records, axes = rows(np.repeat([1.0, 0.0], [80, 20])), np.arange(100) // 2, np.arange(100) % 2
    alarm = fit_alarm(probability_of(level), table, records, np.zeros(100, dtype=bool), axes, 0.1)
    assert logit(np.array([alarm.in_noise, alarm.in_clear])) == pytest.approx([-2.0, 7.9])
    assert alarm.several == pytest.approx((6 * 0.0 + 4 * 1.0) / 10)


def test_a_kurtosis_of_two_hundredths_is_like_noise_and_of_six_clear():
    table = np.zeros((4, len(FEATURE_NAMES)))
    table[:, FEATURE_NAMES.index("median_band_kurtosis")] = [0.02, 0.021, 0.059, 0.06]
    found = clearness(table)
    assert found[0] == 0.0 < found[1] < found[2] < found[3] == pytest.approx(1.0)


@pytest.mark.parametrize(("hidden", "level"), [(20, 0.0), (19, 4.0)])
def test_twenty_rows_like_noise_have_a_level_of_their_own_and_fewer_have_none(hidden, level):
    # Of the rows like noise all say 0, of the others 4: more than half of all rows.
    clear = np.arange(100) >= hidden
    given = probability_of(np.where(clear, 4.0, 0.0)), rows(np.where(clear, 1.0, 0.0)), np.arange(100), ~clear
    assert logit(np.array([fit_alarm(*given, ONE_AXIS[:100], 0.05).in_noise])) == pytest.approx([level])


def test_all_healthy_records_may_be_allowed_to_alarm():
    given = healthy(50, 5)
    alarm = fit_alarm(*given, ONE_AXIS[: given[0].size], 1.0)
    assert alarm.in_noise <= alarm.in_clear < 0.6

import numpy as np
import pytest

from physics.checks import InvalidParameter
from physics.sensor.recorder import Recorder, recorded


def test_the_step_of_16_bits_over_plus_and_minus_500_is_a_65536th_of_1000():
    assert Recorder(500.0, 16).step == 1000.0 / 65536.0


def test_a_recorder_has_16_bits_unless_it_is_said_otherwise():
    assert Recorder(32.768).step == pytest.approx(1e-3, rel=1e-12)


def test_a_signal_within_the_range_moves_by_at_most_half_a_step():
    recorder, signal = Recorder(10.0, 12), np.random.default_rng(1).uniform(-9.9, 9.9, (5000, 2))
    kept, clipped = recorded(recorder, signal)
    assert np.abs(kept - signal).max() <= recorder.step / 2.0
    assert clipped == 0.0
    assert np.std(kept - signal) == pytest.approx(recorder.step / 12.0**0.5, rel=0.02)  # 10 000 uniform errors


def test_what_does_not_fit_is_clipped_to_the_outermost_codes_and_counted():
    signal = np.array([[0.0, 1.3], [-1.3, 0.74], [0.76, -1.0], [0.5, -0.5]])
    kept, clipped = recorded(Recorder(1.0, 3), signal)
    assert kept.tolist() == [[0.0, 0.75], [-1.0, 0.75], [0.75, -1.0], [0.5, -0.5]]
    assert clipped == 2.0 / 8.0  # 1.3 and -1.3: 0.76 rounds to a code that exists


def test_halves_go_to_the_even_code():
    kept, _ = recorded(Recorder(4.0, 3), np.array([[0.5, 1.5], [-0.5, 2.5]]))
    assert kept.tolist() == [[0.0, 2.0], [0.0, 2.0]]


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ((0.0, 16), r"recorder range = 0\.0 m/s²; it must be above 0"),
        ((1.0, 1), "recorder bits = 1; allowed: whole numbers 2 to 32"),
        ((1.0, 33), "recorder bits = 33; allowed: whole numbers 2 to 32"),
    ],
)
def test_an_impossible_recorder_is_refused_with_its_number(fields, message):
    with pytest.raises(InvalidParameter, match=message):
        Recorder(*fields)

"""Plain impulse trains: what is left out of them changes nothing else."""

from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from datagen.benchmark.impulse_signal import Ingredients, Streams, draw_train, impulses, tones
from datagen.benchmark.impulse_training import ingredients_of
from datagen.errors import BadInput
from labels.features.kinematics import Kinematics

NAMES = [field.name for field in fields(Ingredients)]
SEED, HEALTHY, OUTER, INNER = 7, 0, 1, 2


def train(machine, record, *left_out):
    """The record without some ingredients."""
    return draw_train(SEED, machine, record, Ingredients(**dict.fromkeys(left_out, False)))


def test_the_same_numbers_give_the_same_record_and_others_another():
    assert np.array_equal(train(1, OUTER).signal, train(1, OUTER).signal)
    assert train(1, OUTER).kinematics != train(2, OUTER).kinematics
    assert train(1, OUTER).kinematics.balls == train(1, INNER).kinematics.balls


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("record", [HEALTHY, OUTER, INNER])
def test_an_ingredient_left_out_changes_neither_bearing_nor_length(name, record):
    for machine in range(5):
        full, without = train(machine, record), train(machine, record, name)
        assert (without.kinematics, without.signal.size) == (full.kinematics, full.signal.size)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("record", [HEALTHY, OUTER, INNER])
def test_an_ingredient_left_out_leaves_the_background_as_it_is(name, record):
    found = train(3, record).signal - train(3, record, "backgrounds").signal
    left = train(3, record, name).signal - train(3, record, name, "backgrounds").signal
    if name == "backgrounds":
        assert np.abs(found).max() > 0.01
        assert not left.any()
    else:
        assert np.allclose(left, found, rtol=0.0, atol=1e-11)  # rounding of sums


def test_the_floor_of_every_record_is_the_same_noise_at_another_level():
    own, drawn = train(4, HEALTHY, "backgrounds").signal, train(4, HEALTHY, "backgrounds", "machine_floor").signal
    assert np.ptp(drawn / own) < 1e-12 * drawn[0] / own[0]
    assert drawn[0] != own[0]


def test_sensor_paths_and_modulation_are_of_the_impulses_alone():
    for name in ("sensor_paths", "shaft_modulation"):
        assert np.array_equal(train(5, HEALTHY, name).signal, train(5, HEALTHY).signal)
        assert not np.array_equal(train(5, OUTER, name).signal, train(5, OUTER).signal)


def test_impulses_without_modulation_are_those_with_it_divided_by_their_load():
    bearing = Kinematics(9, 0.2, 2.4, 25.0)

    def force(modulated):
        return impulses(Streams(SEED, 1, OUTER), 25_600, 25_600.0, bearing, "outer", modulated)

    plain, loaded = force(False), force(True)
    struck = plain > 0.0
    assert np.array_equal(struck, loaded > 0.0)
    ratio = loaded[struck] / plain[struck]
    assert 0.4 <= ratio.min() < 1.0 < ratio.max() <= 1.6  # a depth of up to 0.6


def test_the_mains_of_a_machine_have_one_frequency():
    seen = set()
    for machine in range(40):
        frequencies = [frequency for frequency, _ in tones(np.random.default_rng(machine), 25.0)][10:14]
        mains = frequencies[0]
        assert frequencies == [mains, 2.0 * mains, 3.0 * mains, 4.0 * mains]
        seen.add(mains)
    assert seen == {50.0, 60.0}


@pytest.mark.parametrize(("location", "fewest", "most"), [("outer", 3.528, 3.6), ("inner", 5.4, 5.472)])
def test_impulses_come_at_the_ball_pass_order_of_their_race(location, fewest, most):
    # Nine balls, a diameter ratio of 0.2: the cage turns at 0.5 (1 − 0.2) = 0.4 of the shaft less a slip of up to 2 %,
    # so 3.528 to 3.6 balls pass the outer race in a turn of the shaft, and what is left of nine the inner one.
    bearing, turns = Kinematics(9, 0.2, 2.4, 25.0), 20 * 25
    for machine in range(5):
        force = impulses(Streams(SEED, machine, OUTER), 20 * 25_600, 25_600.0, bearing, location, True)
        # Jitter of 2 % a period adds up to one impulse more or less in 3000; one more is lost at either end.
        assert fewest * turns - 4 <= np.count_nonzero(force) <= most * turns + 4


def test_only_the_very_names_ask_for_impulse_trains_instead_of_a_folder():
    assert ingredients_of(Path("impulse-trains")) == Ingredients()
    assert ingredients_of(Path("impulse-trains-without-backgrounds")) == Ingredients(backgrounds=False)
    for folder in ("impulse-trains-2", "impulse-trainsbackgrounds", "my/impulse-trains"):
        assert ingredients_of(Path(folder)) is None
    for left_out in ("", "nothing"):
        with pytest.raises(BadInput, match=r"impulse-trains-without-backgrounds"):
            ingredients_of(Path(f"impulse-trains-without-{left_out}"))

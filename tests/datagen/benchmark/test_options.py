"""The options of `classify`."""

from datagen.benchmark.options import SPEED_ERROR
from labels.features.kinematics import MEASURED_WITHIN


def test_every_speed_told_in_training_lies_where_the_features_look_for_the_true_one():
    assert 1.0 / (1.0 - SPEED_ERROR) - 1.0 < MEASURED_WITHIN

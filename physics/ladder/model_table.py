"""The ladder of models by name; the nonlinear one on top is `physics.simulate` itself."""

from __future__ import annotations

from collections.abc import Mapping

from physics.ladder.impulse_train import IMPULSE_TRAIN
from physics.ladder.linear_time_varying import LINEAR_TIME_VARYING
from physics.ladder.model import Model
from physics.ladder.quasi_static import QUASI_STATIC

SIMPLER_MODELS: Mapping[str, Model] = {
    model.name: model for model in (IMPULSE_TRAIN, QUASI_STATIC, LINEAR_TIME_VARYING)
}

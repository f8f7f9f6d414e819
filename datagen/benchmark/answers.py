"""The answers of an estimator as probabilities of our classes; anything else is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.errors import BadInput
from datagen.judging.user_code import FIELD, user_code
from labels.classifier.classes import CLASSES
from physics.arrays import Array

# By how much probabilities, which users may have rounded, may leave the range 0 to 1 or miss a sum of 1.
ROUNDING = 1e-3
ALLOWED = f"names or probabilities of {', '.join(CLASSES)}"


def estimator_name(estimator: Any) -> str:
    """What an estimator is called in reports."""
    return str(getattr(estimator, "__name__", type(estimator).__name__))


def class_probability(estimator: Any, table: Array, name: str) -> Array:
    """Probabilities (N, 5) of CLASSES from `predict_proba`, from `predict`, or from calling the estimator.

    It is given a copy of the `table` (N, F). A class that it never saw has 0. Raises BadInput, which calls the
    estimator by its `name`, for names that are not classes or that `classes_` has twice, for a wrong shape, and for
    numbers that are not probabilities.
    """
    with user_code(name, "it failed to answer"):
        said, names = _answer(estimator, table.copy())
    if len(said) != len(table) or said.ndim not in (1, 2):
        raise _refused(name, f"it answers with the shape {said.shape} to {len(table)} rows")
    if said.ndim == 1:
        words = _known_classes(name, said.tolist())
        return np.asarray(np.array(words)[:, None] == np.asarray(CLASSES)[None, :], dtype=np.float64)
    words = _known_classes(name, names)
    if len(set(words)) < len(words):
        raise _refused(name, "its classes_ name a class twice")
    if said.shape[1] != len(words):
        raise _refused(name, f"it answers with {said.shape[1]} columns for {len(words)} classes")
    return _by_name(_probabilities(name, said), words)


def _answer(estimator: Any, table: Array) -> tuple[NDArray[Any], list[Any]]:
    """The answer and, if it consists of probabilities, the classes of its columns."""
    if hasattr(estimator, "predict_proba"):
        return np.atleast_1d(np.asarray(estimator.predict_proba(table))), list(estimator.classes_)
    said = estimator.predict(table) if hasattr(estimator, "predict") else estimator(table)
    return np.atleast_1d(np.asarray(said)), list(CLASSES)


def _known_classes(name: str, said: list[Any]) -> list[str]:
    """What was said as names of CLASSES; raises BadInput for anything else, whatever it is."""
    words = [str(one) for one in said]
    unknown = [word for word in dict.fromkeys(words) if word not in CLASSES]
    if unknown:
        raise _refused(name, f"it knows classes that are none of ours: {', '.join(unknown[:5])}")
    return words


def _probabilities(name: str, said: NDArray[Any]) -> Array:
    try:
        found = np.asarray(said, dtype=np.float64)
    except (TypeError, ValueError):
        raise _refused(name, "it answers with columns that are no numbers") from None
    inside = np.isfinite(found) & (found >= -ROUNDING) & (found <= 1.0 + ROUNDING)
    if not inside.all() or not np.allclose(found.sum(axis=1), 1.0, atol=ROUNDING):
        raise _refused(name, "it answers with numbers that are no probabilities: each row must sum to 1")
    return np.clip(found, 0.0, 1.0)


def _by_name(probability: Array, names: list[str]) -> Array:
    found = np.zeros((len(probability), len(CLASSES)))
    found[:, [CLASSES.index(name) for name in names]] = probability
    return found


def _refused(name: str, problem: str) -> BadInput:
    return BadInput(problem, field=FIELD, value=name, allowed=ALLOWED)

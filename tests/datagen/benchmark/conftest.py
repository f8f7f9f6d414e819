"""What tests of the benchmark share."""

import pytest


@pytest.fixture
def short_records_are_judged(monkeypatch):
    """The records of the tiny corpus are quick to make, and shorter than any that is judged otherwise."""
    monkeypatch.setattr("datagen.benchmark.fitness.SHORTEST", 0.0)
    monkeypatch.setattr("datagen.benchmark.fitness.FEWEST_TURNS", 0.0)

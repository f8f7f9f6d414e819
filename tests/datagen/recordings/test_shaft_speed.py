from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from datagen.recordings.settings import Tach
from datagen.recordings.shaft_speed import rising_edges, tach_speed


def test_edges_of_a_sine_are_found_where_it_rises_through_its_middle() -> None:
    time = np.arange(20_000) / 10_000.0
    edges = rising_edges(np.sin(2.0 * np.pi * 24.7 * time - 0.4)) / 10_000.0
    assert edges.size == 50
    # A chord of a sine of 405 samples a period is off its zero by far less than a thousandth of a sample.
    assert np.allclose(edges, (np.arange(50) + 0.4 / (2.0 * np.pi)) / 24.7, atol=1e-7)


def test_noise_on_the_edge_of_a_pulse_is_not_counted() -> None:
    pulse = np.concatenate([np.zeros(50), np.linspace(0.0, 1.0, 100), np.ones(50)])
    rough = np.tile(pulse, 8) + 0.03 * np.random.default_rng(1).standard_normal(1600)
    assert rising_edges(rough).size == 8


def test_a_stated_threshold_moves_the_edges() -> None:
    ramps = np.tile(np.arange(100.0), 4)
    assert rising_edges(ramps, 80.5).tolist() == [80.5, 180.5, 280.5, 380.5]


@pytest.mark.parametrize("flat", [np.zeros(100), np.ones(100)])
def test_a_dead_channel_has_no_edges(flat: np.ndarray) -> None:
    assert rising_edges(flat).size == 0


def test_a_pulse_at_the_end_of_a_piece_belongs_to_the_next() -> None:
    pulses = np.zeros(1000)
    pulses[[100, 200, 300, 450, 500, 550]] = 1.0
    source: Any = SimpleNamespace(array=lambda *_: pulses, path="made-up")
    tach = Tach(variable="tacho", threshold=1.0)  # edges on the very samples
    assert tach_speed(source, tach, 1000.0, 0.0, 0.45) == pytest.approx(600.0)
    assert tach_speed(source, tach, 1000.0, 0.45, 1.0) == pytest.approx(1200.0)

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from datagen.corpus import Corpus
from datagen.errors import BadInput
from datagen.recordings.settings import Tach
from datagen.recordings.shaft_speed import rising_edges, tach_speed

Bring = Callable[..., Corpus]
Mat = Callable[..., np.ndarray]


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
    source: Any = SimpleNamespace(path="made-up")
    tach = Tach(variable="tacho", threshold=1.0)  # edges on the very samples
    times = rising_edges(pulses, 1.0) / 1000.0
    assert tach_speed(source, tach, times, 0.0, 0.45) == pytest.approx(600.0)
    assert tach_speed(source, tach, times, 0.45, 1.0) == pytest.approx(1200.0)


def test_a_piece_has_the_mean_of_its_own_part_of_a_speed_channel(bring: Bring, mat: Mat) -> None:
    mat("a.mat", rpm=np.concatenate([np.full(33, 600.0), np.full(33, 900.0), np.full(33, 1200.0)]))
    common = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    speed = 'speed_rpm = {variable = "rpm"}\n'
    assert bring(common + speed, "whole").labels["speed_rpm"].tolist() == pytest.approx([900.0])
    cut = bring(common + speed + "cut_s = 0.1333\n", "cut").labels["speed_rpm"]  # 133 of 400 samples
    assert cut.tolist() == pytest.approx([600.0, 900.0, 1200.0], rel=0.02)


def test_a_column_whose_first_place_alone_holds_the_number_has_no_mean(bring: Bring, mat: Mat) -> None:
    mat("a.mat", table=np.array([[1750.0, 400.0]] + [[0.0, 0.0]] * 99))
    spec = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    told = (
        r'a\.mat: speed_rpm = "table\[:,0\]": is 0 in 99 of 100 places, so .*; allowed: one number of it, as in "NAME'
    )
    with pytest.raises(BadInput, match=told):
        bring(spec + 'speed_rpm = {variable = "table[:,0]"}\n')
    corpus = bring(spec + 'speed_rpm = {variable = "table[0,0]"}\nload_n = {variable = "table[0,1]"}\n')
    assert corpus.labels[["speed_rpm", "load_n"]].to_numpy().tolist() == [[1750.0, 400.0]]


def test_pulses_of_another_length_need_a_rate_of_their_own(bring: Bring, mat: Mat) -> None:
    mat("a.mat", tacho=np.tile([0.0, 0.0, 0.0, 0.0, 1.0], 20))
    spec = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    told = r'a\.mat: tach\.variable = "tacho": holds 100 samples and the vibration 400; allowed: .* in tach\.rate_hz'
    with pytest.raises(BadInput, match=told):
        bring(spec + 'tach = {variable = "tacho"}\n')
    corpus = bring(spec + 'tach = {variable = "tacho", rate_hz = 250}\n')
    assert corpus.labels["speed_rpm"].tolist() == pytest.approx([3000.0])


def test_the_edges_of_a_recording_are_looked_for_once_however_many_its_pieces(
    bring: Bring, mat: Mat, monkeypatch: pytest.MonkeyPatch
) -> None:
    looked = []

    def counting(pulses: np.ndarray, threshold: float | None = None) -> np.ndarray:
        looked.append(pulses.size)
        return rising_edges(pulses, threshold)

    mat("a.mat", tacho=np.tile([0.0, 0.0, 0.0, 0.0, 1.0], 80))
    monkeypatch.setattr("datagen.recordings.shaft_speed.rising_edges", counting)
    corpus = bring(
        '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\ncut_s = 0.05\n'
        'tach = {variable = "tacho"}\n'
    )
    assert len(corpus) == 8
    assert looked == [400, 400]  # once to check it, once to write it

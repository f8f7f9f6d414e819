"""Layers of which a record has nothing are not its layers, and a bearing without load is silent and sound."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from command_line import run

from datagen.corpus import Corpus
from datagen.inspection.check import check_corpus
from datagen.recipes.recipe import parse_recipe
from datagen.records.record import make_record
from datagen.records.response_warnings import lost_in_steps
from datagen.scenarios.sampling import draw_scenario
from physics.sensor.recorder import Recorder, recorded

LOST = """name = "still"
seed = 1
[signal]
rate_hz = 32768
duration_s = 0.01
[[part]]
name = "a"
records = 2
machine.rig = "gearbox"
operation.load_n = 0
[part.defect]
condition = "line"
extent_deg = 2
depth_um = 10
"""
ABOVE = {
    "shaft_harmonics": {"amplitude_m_s2": 1.0, "orders": [900, 901]},
    "gear_mesh": {"teeth": 900, "amplitude_m_s2": 1.0},
}
BELOW = {"mains_hum": {"amplitude_m_s2": 0.1}, "white_rms_m_s2": 0.01}


def layers_of(background: dict[str, object]) -> tuple[str, tuple[float, ...]]:
    part = {"name": "a", "records": 1, "machine": {"rig": "gearbox"}, "operation": {"speed_rpm": 3000}}
    signal = {"rate_hz": 32768, "duration_s": 0.01}
    content = {"name": "a", "seed": 1, "signal": signal, "background": background, "part": [part]}
    labels = make_record(draw_scenario(parse_recipe(content, Path("recipe.toml")), 0)).labels
    return labels["background_layers"], labels["background_rms"]


def test_tones_that_all_lie_above_half_the_rate_are_no_layers() -> None:
    assert layers_of(ABOVE | BELOW)[0] == "white, mains_hum"  # 45 kHz and more of shaft and gears, 16 kHz hold none
    assert layers_of(ABOVE) == ("", (0.0,) * 7)


def test_tones_of_which_some_lie_below_are_a_layer() -> None:
    names, levels = layers_of({"shaft_harmonics": {"amplitude_m_s2": 1.0, "orders": [300, 900]}})
    assert names == "shaft_harmonics"
    assert levels[2] > 0.0


def test_a_bearing_without_load_is_silent_and_its_corpus_sound_and_drawn(tmp_path: Path) -> None:
    (tmp_path / "still.toml").write_text(LOST)
    command = ["generate", str(tmp_path / "still.toml"), "--out", str(tmp_path / "out"), "--workers", "1"]
    assert run(*command).exit_code == 0
    assert not Corpus(tmp_path / "out").to_numpy().any()
    verdict = check_corpus(tmp_path / "out", remake=2)
    assert verdict.sound
    assert verdict.remade == (0, 1)
    assert verdict.largest_difference == 0.0
    assert run("report", tmp_path / "out").exit_code == 0


def idle_labels(background: dict[str, object], load: float = 0.0) -> dict[str, object]:
    part = {"name": "idle", "records": 1, "machine": {"rig": "gearbox"}, "operation": {"load_n": load}}
    signal = {"rate_hz": 20000, "duration_s": 0.2, "envelope_band_hz": [2000, 4000]}
    content = {"name": "zero", "seed": 1, "signal": signal, "background": background, "part": [part]}
    return make_record(draw_scenario(parse_recipe(content, Path("recipe.toml")), 0)).labels


def test_noise_at_a_ratio_to_a_silent_bearing_keeps_the_level_of_the_machine() -> None:
    labels = idle_labels({"white_rms_m_s2": 0.1, "snr_db": 10})
    assert labels["background_rms"][0] == pytest.approx(0.1, rel=0.05)  # 4000 samples: 1.1 % of scatter
    assert math.isnan(labels["snr_db"])  # no signal to compare with
    assert math.isnan(labels["snr_band_db"])


@pytest.mark.parametrize("name", ["snr_db", "snr_band_db"])
def test_a_ratio_that_could_not_be_set_is_a_reason_to_read_a_record_with_care(name: str) -> None:
    told = f"the {name} asked for, 10, could not be set"
    assert told in idle_labels({"white_rms_m_s2": 0.1, name: 10})["validity"]
    assert told not in idle_labels({"white_rms_m_s2": 0.1, name: 10}, load=200.0)["validity"]
    assert told not in idle_labels({"white_rms_m_s2": 0.1})["validity"]


def test_a_recorder_loses_nothing_of_a_signal_that_is_not_there() -> None:
    signal = np.array([[0.0, 0.2], [0.0, -0.3]])
    recorder = Recorder(full_scale=8.0, bits=4)  # its step is 1 m/s²
    kept, _ = recorded(recorder, signal)
    assert not kept.any()
    assert "too coarse for the signal along y: " in lost_in_steps(recorder, signal, kept.astype(np.float32))

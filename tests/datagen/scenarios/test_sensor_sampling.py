"""Chains and backgrounds drawn: whose they are, which stream each comes from, and what is drawn again."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from datagen.recipes.recipe import Recipe, parse_recipe
from datagen.scenarios.background import NoiseTarget
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.streams import stream

RATE = 32768.0
CHAIN: dict[str, Any] = {
    "resonator_gain": {"uniform": [0.5, 2]},
    "mounting_cutoff_hz": {"uniform": [5000, 15000]},
    "recorder_range_m_s2": {"log_uniform": [100, 1000]},
    "recorder_bits": {"choice": [12, 16, 24]},
    "modes": [
        {
            "count": 3,
            "frequency_hz": {"log_uniform": [1000, 15000]},
            "damping": {"log_uniform": [0.01, 0.1]},
            "gain": {"uniform": [0.2, 2]},
        },
        {"frequency_hz": 12000, "damping": 0.02},
    ],
}
DRAWN = {"log_uniform": [0.01, 1]}
BACKGROUND: dict[str, Any] = {
    "white_rms_m_s2": DRAWN,
    "pink": {"rms_m_s2": DRAWN, "lowest_hz": {"uniform": [1, 20]}, "slope": {"uniform": [0.8, 1.5]}},
    "shaft_harmonics": {"amplitude_m_s2": DRAWN, "orders": [1, 3]},
    "gear_mesh": {"teeth": 32, "other_teeth": 49, "amplitude_m_s2": DRAWN, "modulation": {"uniform": [0, 0.5]}},
    "mains_hum": {"amplitude_m_s2": DRAWN, "frequency_hz": {"normal": [50, 0.02]}},
    "impulses": {"per_second": {"uniform": [1, 50]}, "amplitude_m_s2": DRAWN, "frequency_hz": {"uniform": [500, 9000]}},
}


def recipe(chain: dict[str, Any] | None = None, background: dict[str, Any] | None = None) -> Recipe:
    """Two parts of three records on two machines each; healthy, then a line spall."""
    part = {"records": 6, "records_per_machine": 3, "machine": {"rig": "fan"}}
    defect = {"condition": {"choice": ["healthy", "line"]}, "extent_deg": 2, "depth_um": 10}
    content = {
        "name": "try",
        "seed": 5,
        "signal": {"rate_hz": RATE, "duration_s": 0.1},
        "chain": chain or {},
        "background": background or {},
        "part": [part | {"name": "a", "defect": defect}],
    }
    return parse_recipe(content, Path("try.toml"))


def test_the_default_is_the_papers_resonator_alone_and_no_background() -> None:
    scenario = draw_scenario(recipe(), 0)
    assert (scenario.chain.modes, scenario.chain.mounting, scenario.chain.recorder) == ((), None, None)
    assert scenario.chain.resonator_gain == 1.0
    assert (scenario.background.white_rms, scenario.background.pink, scenario.stretch) == (0.0, None, None)


def test_chain_and_floor_belong_to_the_machine_whatever_the_condition_of_its_records() -> None:
    scenarios = [draw_scenario(recipe(CHAIN, BACKGROUND), record) for record in range(6)]
    assert {"healthy", "line"} == {scenario.condition for scenario in scenarios[:3]}
    first, second = scenarios[:3], scenarios[3:]
    for machine in (first, second):
        assert len({scenario.chain for scenario in machine}) == 1
        assert len({scenario.background for scenario in machine}) == 1
    assert first[0].chain != second[0].chain
    assert first[0].background != second[0].background


def test_each_setting_takes_one_number_of_its_own_stream() -> None:
    scenario = draw_scenario(recipe(CHAIN, BACKGROUND), 0)
    number = stream(5, "machine", 0, "chain").random(5)
    chain = scenario.chain
    assert chain.mounting is not None
    assert chain.recorder is not None
    assert chain.resonator_gain == pytest.approx(0.5 + 1.5 * number[0], rel=1e-15)
    assert chain.mounting.cutoff == pytest.approx(5000.0 + 10000.0 * number[1], rel=1e-15)
    assert chain.recorder.full_scale == pytest.approx(100.0 * 10.0 ** number[3], rel=1e-12)
    modes = stream(5, "machine", 0, "sensor_modes").random(10)[1:].reshape(3, 3)
    assert [mode.frequency for mode in chain.modes[:3]] == pytest.approx(1000.0 * 15.0 ** modes[:, 0], rel=1e-12)
    assert [mode.gain for mode in chain.modes[:3]] == pytest.approx(0.2 + 1.8 * modes[:, 2], rel=1e-12)
    pink, background = stream(5, "machine", 0, "pink_noise").random(3), scenario.background
    assert background.pink is not None
    assert background.pink.rms == pytest.approx(0.01 * 100.0 ** pink[0], rel=1e-12)
    assert background.white_rms == pytest.approx(
        0.01 * 100.0 ** stream(5, "machine", 0, "background").random(), rel=1e-12
    )


def test_a_layer_more_moves_no_other() -> None:
    less = {name: settings for name, settings in BACKGROUND.items() if name not in ("pink", "impulses")}
    full, fewer = (draw_scenario(recipe(CHAIN, layers), 4) for layers in (BACKGROUND, less))
    assert (full.background.pink, fewer.background.pink) != (None, None)
    for layer in ("white_rms", "shaft_harmonics", "gear_mesh", "mains_hum"):
        assert getattr(full.background, layer) == getattr(fewer.background, layer)
    assert full.scene == fewer.scene
    assert full.chain == fewer.chain


def test_one_mode_more_moves_no_other() -> None:
    more = CHAIN | {"modes": [CHAIN["modes"][0] | {"count": 4}, CHAIN["modes"][1]]}
    three, four = (draw_scenario(recipe(chain), 0).chain for chain in (CHAIN, more))
    assert four.modes[:3] + four.modes[4:] == three.modes


def test_groups_of_modes_that_are_said_alike_are_drawn_apart() -> None:
    group = {"frequency_hz": {"uniform": [1000, 15000]}, "damping": {"uniform": [0.01, 0.1]}}
    one, other = draw_scenario(recipe({"modes": [group, group]}), 0).chain.modes
    assert one.frequency != other.frequency
    assert one.damping != other.damping


def test_amplitudes_fall_with_their_order_and_each_is_drawn() -> None:
    fixed = {"mains_hum": {"amplitude_m_s2": 6, "harmonics": 3, "decay": 2}}
    hum = draw_scenario(recipe(background=fixed), 0).background.mains_hum
    assert hum is not None
    assert hum.amplitudes == pytest.approx((6.0, 1.5, 6.0 / 9.0), rel=1e-15)
    later = {"shaft_harmonics": {"amplitude_m_s2": 6, "orders": [2, 4], "decay": 1}}
    harmonics = draw_scenario(recipe(background=later), 0).background.shaft_harmonics
    assert harmonics is not None
    assert harmonics.amplitudes == pytest.approx((6.0, 4.0, 3.0), rel=1e-15)  # the first has what was drawn
    drawn = draw_scenario(recipe(background=BACKGROUND), 0).background.shaft_harmonics
    assert drawn is not None
    levels = np.array(drawn.amplitudes) * [1.0, 2.0, 3.0]
    assert len(set(levels.tolist())) == 3
    assert ((levels >= 0.01) & (levels <= 1.0 + 1e-12)).all()


def test_a_resonance_drawn_beyond_half_the_rate_is_drawn_again_and_counted() -> None:
    modes = [{"frequency_hz": {"normal": [16000, 5000]}, "damping": 0.02}]
    scenarios = [draw_scenario(recipe({"modes": modes}), record) for record in range(6)]
    assert all(scenario.chain.modes[0].frequency < RATE / 2.0 for scenario in scenarios)
    redraws = [redraw for scenario in scenarios for redraw in scenario.redraws]
    assert {(redraw.scope, redraw.field) for redraw in redraws} == {("machine", "frequency")}
    assert "allowed: from 0 to below 16384 Hz" in redraws[0].reason


@pytest.mark.parametrize("layer", ["impulses", "pink"])
def test_what_is_drawn_of_a_layer_beyond_half_the_rate_is_drawn_again_and_counted(layer: str) -> None:
    levels: dict[str, Any] = {
        "impulses": {"per_second": 5, "amplitude_m_s2": 1, "resonances": 3, "frequency_hz": {"normal": [16000, 5000]}},
        "pink": {"rms_m_s2": 1, "lowest_hz": {"normal": [16000, 5000]}},
    }
    scenarios = [draw_scenario(recipe(background={layer: levels[layer]}), record) for record in range(6)]
    assert {redraw.scope for scenario in scenarios for redraw in scenario.redraws} == {"machine"}
    for background in (scenario.background for scenario in scenarios):
        found = [ring.frequency for ring in background.impulses.resonances] if background.impulses else []
        found += [background.pink.lowest] if background.pink else []
        assert found
        assert max(found) < RATE / 2.0


@pytest.mark.parametrize("band", [{}, {"snr_band_hz": [500, 900]}])
@pytest.mark.parametrize(("ratio", "whole"), [("snr_db", True), ("snr_band_db", False)])
def test_each_ratio_is_over_its_own_band_whether_a_band_is_stated_or_not(
    ratio: str, whole: bool, band: dict[str, Any]
) -> None:
    scenario = draw_scenario(recipe(background={"white_rms_m_s2": 1, ratio: 7} | band), 0)
    assert scenario.noise_target == NoiseTarget(7.0, whole)


def test_a_fixed_ratio_is_drawn_for_each_record() -> None:
    settings = {"white_rms_m_s2": 1, "snr_band_db": {"uniform": [-5, 5]}, "snr_band_hz": [500, 900]}
    scenarios = [draw_scenario(recipe(background=settings), record) for record in range(3)]
    targets = [scenario.noise_target for scenario in scenarios]
    assert len(set(targets)) == 3
    assert all(isinstance(target, NoiseTarget) and not target.whole for target in targets)
    assert {scenario.noise_band for scenario in scenarios} == {(500.0, 900.0)}


def test_without_a_band_of_its_own_the_ratio_is_over_the_envelopes() -> None:
    scenario = draw_scenario(recipe(background=BACKGROUND), 0)
    assert scenario.noise_band == scenario.envelope_band


def stretches(folder: Path, columns: int) -> tuple[np.ndarray, list[Any]]:
    """A recording of sample numbers, and what three records take of it."""
    recording = np.arange(4000 * columns, dtype=np.float32).reshape(columns, 4000).T
    np.save(folder / "healthy.npy", recording)
    content = recipe().model_dump(mode="json")
    settings = {"recording": {"file": "healthy.npy", "rate_hz": RATE, "gain_m_s2": {"uniform": [1, 2]}}}
    read = parse_recipe(content | {"background": settings}, folder / "recipe.toml")
    return recording, [draw_scenario(read, record) for record in range(3)]


def test_one_column_goes_to_each_axis_from_its_own_place(tmp_path: Path) -> None:
    recording, scenarios = stretches(tmp_path, 1)
    assert len({scenario.background.recording_gain for scenario in scenarios}) == 1
    for scenario in scenarios:
        taken = scenario.stretch
        assert taken is not None
        assert taken.starts[0] != taken.starts[1]
        for axis, start in enumerate(taken.starts):
            assert np.array_equal(taken.samples[:, axis], recording[start : start + scenario.samples, 0])
    assert len({scenario.stretch.starts for scenario in scenarios if scenario.stretch}) == 3


def test_two_columns_go_to_x_and_y_from_one_place(tmp_path: Path) -> None:
    recording, scenarios = stretches(tmp_path, 2)
    taken = scenarios[0].stretch
    assert taken is not None
    assert taken.starts[0] == taken.starts[1]
    assert np.array_equal(taken.samples, recording[taken.starts[0] : taken.starts[0] + scenarios[0].samples])


def test_each_wheel_of_a_gear_mesh_has_its_own_teeth_and_modulation() -> None:
    gears = {"teeth": 32, "other_teeth": 49, "amplitude_m_s2": 1, "modulation": 0.1, "other_modulation": 0.3}
    mesh = draw_scenario(recipe(background={"gear_mesh": gears}), 0).background.gear_mesh
    assert mesh is not None
    assert (mesh.teeth, mesh.other_teeth, mesh.modulation, mesh.other_modulation) == (32, 49, 0.1, 0.3)

"""Records with a measurement chain and every layer of background: they add up, and their text alone remakes them."""

from __future__ import annotations

import math
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from datagen.corpus import Corpus
from datagen.inspection.check import check_corpus
from datagen.recipes.recipe import Recipe, load_recipe
from datagen.records.record import make_record
from datagen.runs.generate import generate
from datagen.runs.workers import Engine
from datagen.scenarios.background import Background, NoiseTarget
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario_text import scenario_of
from labels.envelope import band_envelope
from labels.noise import signal_to_noise
from labels.schema import LAYERS

RECIPE = """
name = "sensors"
seed = 11
[signal]
rate_hz = 32768
duration_s = 0.0625
[store]
clean = true
sensor = true
background = true
records_per_shard = 8
[chain]
mounting_cutoff_hz = 11000
[[chain.modes]]
count = 3
frequency_hz = {log_uniform = [1000, 15000]}
damping = {log_uniform = [0.01, 0.05]}
gain = {log_uniform = [0.2, 2]}
[background]
white_rms_m_s2 = 0.1
pink.rms_m_s2 = 0.2
shaft_harmonics.amplitude_m_s2 = 0.05
gear_mesh = {teeth = 32, other_teeth = 49, amplitude_m_s2 = 0.2}
mains_hum.amplitude_m_s2 = 0.03
impulses = {per_second = 300, amplitude_m_s2 = 1, frequency_hz = {log_uniform = [500, 10000]}}
recording = {file = "healthy.npy", rate_hz = 32768, gain_m_s2 = 0.05}
[[part]]
name = "all layers"
records = 3
records_per_machine = 3
machine.rig = "gearbox"
[part.defect]
condition = {choice = ["healthy", "line"]}
extent_deg = 2
depth_um = 10
[[part]]
name = "recorded"
records = 2
machine.rig = "fan"
chain = {recorder_range_m_s2 = 4, recorder_bits = 12}
background = {white_rms_m_s2 = 0.1, snr_db = 5, snr_band_hz = [1000, 3000]}
[part.defect]
condition = "line"
extent_deg = 2
depth_um = 10
"""


@pytest.fixture(scope="module")
def recipe(tmp_path_factory: pytest.TempPathFactory) -> Recipe:
    folder = tmp_path_factory.mktemp("recipe")
    np.save(folder / "healthy.npy", np.random.default_rng(1).standard_normal(20_000))
    (folder / "recipe.toml").write_text(RECIPE)
    return load_recipe(folder / "recipe.toml")


@pytest.fixture(scope="module")
def folder(recipe: Recipe, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("corpus") / "sensors"
    assert generate(recipe, folder, engine=Engine(workers=1)).complete
    return folder


@pytest.fixture(scope="module")
def corpus(folder: Path) -> Corpus:
    return Corpus(folder)


def parts(corpus: Corpus, record: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The stored record (T, 2), its sensor signal (T, 2) and its layers (L, T, 2)."""
    names = ("acceleration", "acceleration_sensor", "background")
    found = [corpus.waveform(record, name).astype(np.float64) for name in names]
    return found[0], found[1], found[2]


@pytest.mark.parametrize("record", [0, 1, 2])
def test_the_layers_plus_the_clean_sensor_signal_are_the_record(corpus: Corpus, record: int) -> None:
    signal, sensor, layers = parts(corpus, record)
    # nine numbers rounded to float32, 6e-8 of each
    assert signal == pytest.approx(sensor + layers.sum(axis=0), abs=5e-7 * np.abs(signal).max())
    assert all(layer.any() for layer in layers)


@pytest.mark.parametrize("record", [3, 4])
def test_the_recorder_rounds_that_sum_and_clips_it_at_its_range(corpus: Corpus, record: int) -> None:
    signal, sensor, layers = parts(corpus, record)
    given = sensor + layers.sum(axis=0)
    step = 2.0 * 4.0 / 2.0**12
    labels = corpus.labels.set_index("record").loc[record]
    assert labels["recorder_step"] == step
    inside = (given >= -4.0) & (given <= 4.0 - step)
    assert np.abs(signal - given)[inside].max() <= step / 2.0 * (1.0 + 1e-3)  # float32 of what is compared with
    assert set(signal[~inside].tolist()) <= {-4.0, 4.0 - step}
    assert labels["clipped_share"] == pytest.approx(np.mean(~inside), abs=2.0 / given.size)  # half a step at the rim
    assert labels["clipped_share"] > 0.0
    assert np.array_equal(np.round(signal / step) * step, signal)


def test_the_envelope_is_that_of_what_the_recorder_keeps(corpus: Corpus) -> None:
    band = corpus.labels.set_index("record").loc[3, ["envelope_band_low", "envelope_band_high"]]
    _, sensor, layers = parts(corpus, 3)
    unrecorded = sensor[:, 1] + layers.sum(axis=0)[:, 1]
    of_both = [band_envelope(signal, 32768.0, tuple(band)) for signal in (corpus.signal(3), unrecorded)]
    assert np.array_equal(corpus.waveform(3, "envelope"), of_both[0].astype(np.float32))
    assert not np.allclose(*of_both, rtol=1e-2)


def test_the_labels_say_which_layers_there_are_and_their_rms(corpus: Corpus) -> None:
    table = corpus.labels.set_index("record")
    for record in range(5):
        _, _, layers = parts(corpus, record)
        rms = np.sqrt(np.mean(layers[:, :, 1] ** 2, axis=1))
        assert [table[f"background_rms_{name}"][record] for name in LAYERS] == pytest.approx(rms, rel=1e-5)  # float32
    assert table["background_layers"].tolist() == [", ".join(LAYERS)] * 3 + ["white"] * 2
    assert table["sensor_modes"].tolist() == [3, 3, 3, 0, 0]
    assert table["mounting_cutoff_hz"].tolist()[:3] == [11000.0] * 3
    assert table["mounting_cutoff_hz"][3:].isna().all()
    assert table["recorder_step"][:3].isna().all()


def test_the_ratios_are_those_of_sensor_signal_and_background_over_their_bands(corpus: Corpus) -> None:
    table = corpus.labels.set_index("record")
    for record in range(5):
        _, sensor, layers = parts(corpus, record)
        noise, row = layers.sum(axis=0)[:, 1], table.loc[record]
        band = (row["snr_band_low"], row["snr_band_high"])
        assert row["snr_db"] == pytest.approx(signal_to_noise(sensor[:, 1], noise, 32768.0), abs=1e-3)  # float32
        assert row["snr_band_db"] == pytest.approx(signal_to_noise(sensor[:, 1], noise, 32768.0, band), abs=1e-3)
    assert table["snr_db"][3:].tolist() == pytest.approx([5.0, 5.0], abs=1e-9)  # as the recipe fixes it


def test_a_machines_floor_is_the_same_in_its_healthy_and_its_faulty_records(corpus: Corpus) -> None:
    table = corpus.labels.set_index("record").loc[:2]
    assert set(table["condition"]) == {"healthy", "line"}
    assert table["background_rms_white"].std() < 0.05 * 0.1  # 2048 samples: 1.6 % scatter; three of them
    healthy, faulty = (table[table["condition"] == word]["snr_db"].mean() for word in ("healthy", "line"))
    assert faulty > healthy + 20.0


def test_the_whole_corpus_checks_and_is_remade_from_its_scenarios(folder: Path, tmp_path: Path) -> None:
    verdict = check_corpus(Path(shutil.copytree(folder, tmp_path / "copy")), remake=5)
    assert verdict.problems == ()
    assert verdict.remade == (0, 1, 2, 3, 4)
    assert verdict.largest_difference == 0.0


def test_the_text_gives_sensor_signal_and_layers_again_without_recipe_and_recording(corpus: Corpus) -> None:
    scenario = scenario_of(str(corpus.waveform(1, "scenario")))
    again = make_record(scenario, ("acceleration_sensor", "background"))
    assert np.array_equal(again.acceleration_sensor, corpus.waveform(1, "acceleration_sensor"))
    assert np.array_equal(again.background, corpus.waveform(1, "background"))


def test_the_corpus_says_no_place_of_this_machine(folder: Path, recipe: Recipe) -> None:
    assert str(Path(recipe.source).parent) not in (folder / "manifest.json").read_text()


@pytest.mark.parametrize("whole", [True, False])
def test_a_fixed_ratio_scales_all_layers_alike_to_it(recipe: Recipe, whole: bool) -> None:
    scenario = draw_scenario(recipe, 1)
    absolute = make_record(scenario, ("background",))
    target = {"noise_target": NoiseTarget(-3.0, whole), "snr_band": (1000.0, 3000.0)}
    fixed = make_record(replace(scenario, **target), ("background",))
    assert fixed.labels["snr_db" if whole else "snr_band_db"] == pytest.approx(-3.0, abs=1e-9)
    assert absolute.background is not None
    assert fixed.background is not None
    factors = [
        new[:, 1].std() / old[:, 1].std() for new, old in zip(fixed.background, absolute.background, strict=True)
    ]
    assert factors == pytest.approx([factors[0]] * len(LAYERS), rel=1e-5)  # float32
    assert factors[0] != pytest.approx(1.0, rel=1e-3)


def test_without_chain_and_background_the_record_is_the_clean_signal(recipe: Recipe) -> None:
    scenario = draw_scenario(recipe, 3)
    bare = replace(scenario, chain=replace(scenario.chain, recorder=None), background=Background(), noise_target=None)
    record = make_record(bare, ("acceleration_clean", "acceleration_sensor"))
    assert record.acceleration_clean is not None
    assert np.array_equal(record.acceleration, record.acceleration_clean)
    assert np.array_equal(record.acceleration, record.acceleration_sensor)
    assert math.isnan(record.labels["snr_db"])
    assert math.isnan(record.labels["snr_band_db"])
    assert record.labels["background_layers"] == ""


@pytest.mark.parametrize(("full_scale", "said"), [(4.0, ""), (1e6, "along x and y: every sample there is 0")])
def test_a_recorder_too_coarse_for_the_signal_is_told_of(recipe: Recipe, full_scale: float, said: str) -> None:
    scenario = draw_scenario(recipe, 3)
    recorder = replace(scenario.chain.recorder, full_scale=full_scale)  # of 12 bits
    record = make_record(replace(scenario, chain=replace(scenario.chain, recorder=recorder)))
    assert bool(said) != record.acceleration.any()
    step = f"the recorder's step of {full_scale / 2**11:.3g} m/s² is too coarse for the signal {said}"
    assert (step in record.labels["validity"]) == bool(said)


@pytest.mark.parametrize(("share", "told"), [(0.008, False), (0.2, True)])
def test_a_recorder_whose_range_is_exceeded_often_is_told_of(recipe: Recipe, share: float, told: bool) -> None:
    scenario = draw_scenario(recipe, 3)
    whole = make_record(replace(scenario, chain=replace(scenario.chain, recorder=None))).acceleration
    full_scale = float(np.quantile(np.abs(whole), 1.0 - share))
    recorder = replace(scenario.chain.recorder, full_scale=full_scale, bits=24)
    labels = make_record(replace(scenario, chain=replace(scenario.chain, recorder=recorder))).labels
    said = f"0.2 of the samples are cut off at the recorder's range of {full_scale:.3g} m/s²"
    assert (said in labels["validity"]) == told
    assert labels["clipped_share"] == pytest.approx(share, rel=0.05)

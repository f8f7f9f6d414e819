"""Measurement chain and background in a recipe: what is read, and what is refused in one line."""

from __future__ import annotations

import math
import shutil
import tomllib
from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pytest
from command_line import run
from scipy.io import savemat, wavfile

from datagen.distributions.kinds import Fixed
from datagen.errors import BadInput
from datagen.recipes.recipe import Recipe, load_recipe, parse_recipe
from datagen.recipes.recording_settings import RecordedLayerSettings

BASE = """name = "try"
seed = 1
[signal]
rate_hz = 32768
duration_s = 0.1
[[part]]
name = "a"
records = 1
machine.rig = "fan"
"""
MODES = "[[part.chain.modes]]\nfrequency_hz = 500\ndamping = 0.02"
RECORDING = "[part.background.recording]\nfile = {file!r}\n"
SAMPLES = 5000


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Recordings of every kind, good and bad."""
    folder = tmp_path_factory.mktemp("recordings")
    ramp = np.linspace(-0.5, 0.5, SAMPLES)
    np.save(folder / "good.npy", ramp)
    np.save(folder / "short.npy", ramp[:100])
    np.save(folder / "nan.npy", np.append(ramp, np.nan))
    np.save(folder / "huge.npy", np.append(ramp, 1e300))
    np.save(folder / "wide.npy", np.tile(ramp[:, None], 3))
    np.save(folder / "words.npy", np.array(["a", "b"]))
    np.savez(folder / "uneven.npz", a=ramp, b=ramp[1:])
    np.savez(folder / "two.npz", a=ramp, b=ramp, rate_hz=32768)
    wavfile.write(folder / "good.wav", 32768, np.round(ramp * 2**15).astype(np.int16))
    wavfile.write(folder / "other.wav", 44100, np.zeros(SAMPLES, np.int16))
    lines = ["time,a", *(f"{k},{value!r}" for k, value in enumerate(ramp.tolist()))]
    savemat(folder / "good.mat", {"DE_time": ramp[:, None], "RPM": 1797})
    (folder / "good.csv").write_text("\n".join(lines))
    (folder / "bad.csv").write_text("a,b\n1,2\n3,x\n")
    (folder / "cut.npz").write_bytes((folder / "two.npz").read_bytes()[:500])
    (folder / "x.abc").write_bytes(b"")
    return folder


def load(folder: Path, text: str) -> Recipe:
    """The recipe whose only part has `text`, read from a file in `folder`."""
    path = folder / "recipe.toml"
    path.write_text(BASE + text, encoding="utf-8")
    return load_recipe(path)


BAD = [
    (f"{MODES}\ncount = 51", "part[1].chain.modes[1].count = 51; allowed: a whole number from 0 to 50"),
    (MODES.replace("500", "-5"), "part[1].chain.modes[1].frequency_hz = -5; allowed: a number from 0.001"),
    (
        MODES.replace("500", "{uniform = [900, 20000]}"),
        "line 11: part[1].chain.modes[1].frequency_hz = 20000.0: the resonance must lie below half the sampling rate "
        "of 32768 Hz; allowed: below 16384",
    ),
    (MODES.replace("0.02", "0.8"), "part[1].chain.modes[1].damping = 0.8; allowed: a number above 0 to 0.7"),
    (f"{MODES}\ngain = -1", "part[1].chain.modes[1].gain = -1; allowed: a number from 0"),
    (
        "[part.chain]\nmounting_cutoff_hz = 16384",
        "part[1].chain.mounting_cutoff_hz = 16384.0: the cutoff must lie below half the sampling rate of 32768 Hz",
    ),
    ("[part.chain]\nmounting_cutof_hz = 1", 'did you mean "mounting_cutoff_hz"?'),
    ("[part.chain]\nrecorder_range_m_s2 = 0", "part[1].chain.recorder_range_m_s2 = 0; allowed: a number from 1e-06"),
    ("[part.background]\nwhite_rms_m_s2 = -0.1", "part[1].background.white_rms_m_s2 = -0.1; allowed: a number from 0"),
    ("[part.background.pink]\nrms_m_s2 = -1", "part[1].background.pink.rms_m_s2 = -1; allowed: a number from 0"),
    ("[part.background.pink]\nrms_m_s2 = 1\nlowest_hz = 17000", "the band of the noise must lie below half"),
    (
        "[part.background.shaft_harmonics]\namplitude_m_s2 = -1",
        "part[1].background.shaft_harmonics.amplitude_m_s2 = -1; allowed: a number from 0",
    ),
    ("[part.background.shaft_harmonics]\namplitude_m_s2 = 1\norders = [3, 2]", "the first order comes first"),
    ("[part.background.gear_mesh]\namplitude_m_s2 = 1", "part[1].background.gear_mesh.teeth: this setting is missing"),
    (
        "[part.background.gear_mesh]\namplitude_m_s2 = -1\nteeth = 32",
        "gear_mesh.amplitude_m_s2 = -1; allowed: a number",
    ),
    (
        "[part.background.mains_hum]\namplitude_m_s2 = {uniform = [-1, 1]}",
        "mains_hum.amplitude_m_s2 = {uniform = [-1, 1]}; allowed: a number from 0",
    ),
    (
        "[part.background.impulses]\nper_second = 5\namplitude_m_s2 = 1\nfrequency_hz = 20000",
        "part[1].background.impulses.frequency_hz = 20000.0: the resonance must lie below half the sampling rate",
    ),
    (
        "[part.background]\nsnr_band_hz = [1000, 20000]",
        "part[1].background.snr_band_hz = [1000.0, 20000.0]: the band is not below half the sampling rate of 32768 Hz; "
        "allowed: 0 <= low < high <= 16384",
    ),
    ("[part.background]\nsnr_band_hz = [2000, 1000]", "snr_band_hz = [2000, 1000]: the band is empty"),
    ("[part.background]\nsnr_db = 3", "snr_db = 3: there is no layer to scale; allowed: a layer beside it"),
    ("[part.background]\nwhite_rms_m_s2 = 1\nsnr_db = 3\nsnr_band_db = 4", "set the same thing twice"),
]
BAD_RECORDINGS = [
    ("gone.npy", "rate_hz = 32768", "gone.npy: no such file"),
    (".", "rate_hz = 32768", ": this is a folder"),
    (
        "x.abc",
        "",
        "x.abc: the file's name does not end like that of a known format; "
        "allowed: mat, npz, npy, csv, wav, nc; csv is any table of text",
    ),
    ("bad.csv", 'rate_hz = 32768\nchannels = ["b"]', "bad.csv: it holds NaN at sample 1 (1 such of 2 samples)"),
    ("cut.npz", "", "cut.npz: cannot be read as an .npz file"),
    ("words.npy", "rate_hz = 32768", "words.npy: no table of numbers"),
    ("nan.npy", "rate_hz = 32768", "nan.npy: it holds NaN at sample 5000 (1 such of 5001 samples); allowed: finite"),
    ("huge.npy", "rate_hz = 32768", "huge.npy: it holds a number that is not finite at sample 5000"),
    ("good.npy", "", "recording.rate_hz: good.npy does not state its sampling rate; allowed: a number of Hz"),
    (
        "good.npy",
        "rate_hz = 48000",
        "line 12: part[1].background.recording.rate_hz = 48000.0: good.npy is not sampled at the records' rate, and "
        "recordings are not resampled; allowed: 32768 (signal.rate_hz)",
    ),
    ("good.npy", 'rate_hz = "x"', 'recording.rate_hz = "x"; allowed: a number'),
    ("other.wav", "", "rate_hz = 44100.0: other.wav is not sampled at the records' rate"),
    ("other.wav", "rate_hz = 32768", "rate_hz = 32768: other.wav says 44100 Hz; allowed: 44100"),
    ("short.npy", "rate_hz = 32768", "short.npy is 0.00305176 s long, a record 0.1 s, and recordings are not repeated"),
    ("wide.npy", "rate_hz = 32768", "recording.channels: wide.npy: it has 3 columns; allowed: one or two, as in"),
    ("wide.npy", 'rate_hz = 32768\nchannels = ["data[:,3]"]', "wide.npy: data is an array of 5000x3 numbers"),
    ("two.npz", "", "recording.channels: two.npz: it has 2 variables; allowed: one or two of ['a', 'b']"),
    ("two.npz", 'channels = ["c"]', "two.npz: the file has no such variable"),
    ("two.npz", 'channels = "a"', 'recording.channels = "a"; allowed: a list'),
    ("two.npz", 'channels = ["a", "b", "a"]', "; allowed: at most 2"),
    ("x" * 300, "rate_hz = 32768", "it cannot be read (File name too long)"),
    ("uneven.npz", 'channels = ["a", "b"]\nrate_hz = 32768', "uneven.npz: the two channels are not equally long"),
    ("good.csv", 'rate_hz = 32768\ncsv.delimiter = ",,"', 'recording.csv.delimiter = ",,"; allowed: one character'),
    ("good.npy", "rate_hz = 32768\ngain_m_s2 = -1", "recording.gain_m_s2 = -1; allowed: a number from 0"),
    ("good.npy", f'rate_hz = 32768\nsha256 = "{"0" * 64}"', "good.npy is another file: its SHA-256 is"),
]


@pytest.mark.parametrize(("text", "message"), BAD)
def test_an_impossible_chain_or_background_is_refused_in_one_line(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(BadInput) as caught:
        load(tmp_path, text)
    assert message in str(caught.value)
    assert str(tmp_path / "recipe.toml") in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("file", "more", "message"), BAD_RECORDINGS)
def test_a_recording_that_does_not_fit_is_refused_in_one_line(file: str, more: str, message: str, folder: Path) -> None:
    with pytest.raises(BadInput) as caught:
        load(folder, RECORDING.format(file=file) + more)
    assert message in str(caught.value)
    assert "part[1].background.recording" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_recording_is_found_where_its_recipe_was_read_wherever_its_user_goes(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "recipe.toml").write_text(BASE + RECORDING.format(file="good.npy") + "rate_hz = 32768")
    monkeypatch.chdir(folder)
    recording = load_recipe("recipe.toml").part[0].background.recording
    monkeypatch.chdir(tmp_path)
    assert recording is not None
    assert recording.load().shape == (SAMPLES, 1)


def test_of_drawn_rates_a_frequency_must_lie_below_half_the_lowest(folder: Path) -> None:
    text = BASE.replace("rate_hz = 32768", "rate_hz = {choice = [30000.0, 65536.0]}")
    for cutoff, refused in ((14_000, False), (16_000, True)):
        (folder / "recipe.toml").write_text(f"{text}chain = {{mounting_cutoff_hz = {cutoff}}}\n")
        said = r"mounting_cutoff_hz = 16000\.0: .* half the sampling rate of 30000 Hz; allowed: below 15000"
        with pytest.raises(BadInput, match=said) if refused else nullcontext():
            load_recipe(folder / "recipe.toml")


def test_two_tables_are_no_two_channels(folder: Path) -> None:
    np.savez(folder / "tables.npz", a=np.ones((9000, 2)), b=np.zeros((9000, 2)))
    text = RECORDING.format(file="tables.npz") + 'rate_hz = 32768\nchannels = ["a", "b"]'
    with pytest.raises(BadInput, match="the two channels are not equally long"):
        load(folder, text)


def test_records_of_drawn_rates_take_no_recording(folder: Path) -> None:
    drawn = BASE.replace("rate_hz = 32768", "rate_hz = {choice = [32768.0, 65536.0]}")
    (folder / "recipe.toml").write_text(drawn + RECORDING.format(file="good.npy") + "rate_hz = 32768")
    with pytest.raises(BadInput, match=r"rate is drawn.*allowed: signal\.rate_hz = 32768"):
        load_recipe(folder / "recipe.toml")


@pytest.mark.parametrize("text", [MODES.replace("500", "16384"), RECORDING.format(file="nan.npy") + "rate_hz = 32768"])
def test_the_command_ends_with_2_and_writes_nothing(text: str, folder: Path, tmp_path: Path) -> None:
    with pytest.raises(BadInput):
        load(folder, text)
    out = tmp_path / "corpus"
    done = run("generate", folder / "recipe.toml", "--out", out)
    assert done.exit_code == 2
    assert not out.exists()
    assert len(done.stderr.strip().splitlines()) == 1


@pytest.mark.parametrize(
    ("file", "more"),
    [
        ("good.npy", "rate_hz = 32768"),
        ("good.wav", ""),
        ("good.csv", 'rate_hz = 32768\nchannels = ["a"]'),
        ("two.npz", 'channels = ["b"]'),
        ("wide.npy", 'rate_hz = 32768\nchannels = ["data[:,2]"]'),
        ("good.mat", 'rate_hz = 32768\nchannels = ["*_time"]'),
    ],
)
def test_every_kind_of_file_gives_the_same_recording(file: str, more: str, folder: Path) -> None:
    recording = load(folder, RECORDING.format(file=file) + more).part[0].background.recording
    assert (recording.rate_hz, recording.samples) == (32768.0, SAMPLES)
    # float32, and steps of 2^-15 in the .wav
    assert recording.load()[:, 0] == pytest.approx(np.linspace(-0.5, 0.5, SAMPLES), abs=2e-5)


def test_a_recipe_kept_as_data_describes_its_recording_but_cannot_draw_without_it(folder: Path, tmp_path: Path) -> None:
    recipe = load(folder, RECORDING.format(file="good.npy") + "rate_hz = 32768")
    kept = recipe.model_dump(mode="json")
    assert str(folder) not in str(kept)
    elsewhere = parse_recipe(kept, tmp_path / "manifest.json")
    assert elsewhere.hash == recipe.hash
    assert (recipe.drawable, elsewhere.drawable) == (True, False)
    with pytest.raises(BadInput, match=r"good\.npy: the recording \(SHA-256 [0-9a-f]{64}\) is not at hand"):
        elsewhere.part[0].background.recording.load()


@pytest.mark.parametrize("file", ["good.npy", "gone.npy"])
def test_a_recipe_does_not_say_where_a_recording_was_found(file: str, folder: Path) -> None:
    kept = load(folder, RECORDING.format(file="good.npy") + "rate_hz = 32768").model_dump(mode="json")
    kept["part"][0]["background"]["recording"] |= {"file": file, "path": str(folder / "good.npy")}
    with pytest.raises(BadInput, match=r"recording\.path = .*: unknown key"):
        parse_recipe(kept, folder / "recipe.toml")
    with pytest.raises(BadInput, match=r"recording\.pith: unknown key \(known here: file, rate_hz, .*, samples\)"):
        load(folder, RECORDING.format(file="good.npy") + "rate_hz = 32768\npith = 1")


def test_a_recording_that_changes_is_refused_by_the_old_recipe_and_taken_by_one_read_again(tmp_path: Path) -> None:
    def read(value: float) -> RecordedLayerSettings:
        np.save(tmp_path / "good.npy", np.full(SAMPLES, value))
        return load(tmp_path, RECORDING.format(file="good.npy") + "rate_hz = 32768").part[0].background.recording

    old = read(1.0)
    assert (old.load() == 1.0).all()
    assert (read(2.0).load() == 2.0).all()
    unread = read(3.0)
    read(4.0)
    with pytest.raises(BadInput, match="the recording has changed since the recipe was read"):
        unread.load()
    assert (old.load() == 1.0).all()  # kept from before


def test_another_recording_is_another_recipe(folder: Path, tmp_path: Path) -> None:
    text = RECORDING.format(file="good.npy") + "rate_hz = 32768"
    first = load(folder, text)
    shutil.copy(folder / "good.npy", tmp_path / "good.npy")
    assert load(tmp_path, text).hash == first.hash
    np.save(tmp_path / "good.npy", np.ones(SAMPLES))
    assert load(tmp_path, text).hash != first.hash


def test_a_part_without_a_table_of_its_own_takes_the_recipes(tmp_path: Path) -> None:
    (tmp_path / "recipe.toml").write_text(
        BASE.replace("[[part]]", "[chain]\nresonator_gain = 2\n[background]\nwhite_rms_m_s2 = 3\n[[part]]")
        + 'chain = {resonator_gain = 4}\n[[part]]\nname = "b"\nrecords = 1\nmachine.rig = "fan"\n'
        + "background = {white_rms_m_s2 = 5}\n"
    )
    recipe = load_recipe(tmp_path / "recipe.toml")
    assert [recipe.chain_of(part).resonator_gain for part in recipe.part] == [Fixed(4.0), Fixed(2.0)]
    assert [recipe.background_of(part).white_rms_m_s2 for part in recipe.part] == [Fixed(3.0), Fixed(5.0)]


def test_the_example_on_the_datasets_page_is_a_recipe(folder: Path) -> None:
    page = (Path(__file__).parents[3] / "datasets" / "README.md").read_text(encoding="utf-8")
    example = page.split("### Chain and background")[1].split("```toml")[1].split("```")[0]
    shutil.copy(folder / "good.wav", folder / "healthy.wav")
    text = BASE.replace("[[part]]", example.replace("20000]", "15000]") + "[[part]]")  # the page is for 65 536 Hz
    (folder / "recipe.toml").write_text(text)
    recipe = load_recipe(folder / "recipe.toml")
    assert recipe.background.recording is not None
    assert recipe.background.recording.samples == SAMPLES
    assert recipe.background.snr_band_hz == (1000.0, 5000.0)


def test_a_recording_exactly_as_long_as_a_record_is_taken(folder: Path) -> None:
    shortest = round(0.1 * 32768)
    text = RECORDING.format(file="exact.npy") + "rate_hz = 32768"
    np.save(folder / "exact.npy", np.linspace(-0.5, 0.5, shortest))
    assert load(folder, text).part[0].background.recording.samples == shortest
    np.save(folder / "exact.npy", np.linspace(-0.5, 0.5, shortest - 1))
    with pytest.raises(BadInput, match="recordings are not repeated"):
        load(folder, text)


def test_a_recording_lasts_as_long_as_the_longest_record_that_can_be_drawn(folder: Path) -> None:
    drawn = BASE.replace("duration_s = 0.1", "duration_s = {uniform = [0.1, 0.2]}")
    (folder / "recipe.toml").write_text(drawn + RECORDING.format(file="good.npy") + "rate_hz = 32768")
    with pytest.raises(BadInput, match=r"good\.npy is 0\.152588 s long, a record 0\.2 s"):  # 5000 samples
        load_recipe(folder / "recipe.toml")


def test_a_noise_band_may_end_at_half_the_rate(tmp_path: Path) -> None:
    text = "[part.background]\nwhite_rms_m_s2 = 1\nsnr_band_hz = [1000, 16384]"
    assert load(tmp_path, text).part[0].background.snr_band_hz == (1000.0, 16384.0)


def test_half_the_rate_lies_above_the_resonance_of_a_rig_of_the_catalogue(tmp_path: Path) -> None:
    # Petersen et al. 2014, Table 2: 371.5 MN/m between 0.1 kg and a free ring of 2.5 kg.
    hertz = math.sqrt(371.5e6 * (1.0 / 0.1 + 1.0 / 2.5)) / math.tau
    path, content = tmp_path / "recipe.toml", tomllib.loads(BASE)
    content["signal"]["rate_hz"] = 2.0 * hertz + 1.0
    assert parse_recipe(content, path).count == 1
    content["signal"]["rate_hz"] = 2.0 * hertz - 1.0
    with pytest.raises(BadInput, match=rf'rig = "fan": its resonance at {hertz:.0f} Hz must lie below half'):
        parse_recipe(content, path)
    content["signal"]["envelope_band_hz"] = [2000.0, 5000.0]
    assert parse_recipe(content, path).count == 1

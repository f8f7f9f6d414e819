"""What an import warns of: it comes in all the same."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_line import run
from imports import Mat, noise
from scipy.io import wavfile

from datagen.corpus import Corpus


def test_a_dead_sensor_comes_in_with_a_warning(mat: Mat, tmp_path: Path) -> None:
    for name in ("dead.mat", "gone.mat"):
        mat(name, np.full(400, 2.5), other=np.zeros(400))
    mat("half.mat", other=np.zeros(400))
    (tmp_path / "spec.toml").write_text(
        'name = "mine"\n[[recording]]\nname = "all"\nfiles = "*.mat"\nrate_hz = 1000\nunit = "g"\n'
        'x = "other"\ny = "sig"\n'
    )
    code, shown, message = run("import", tmp_path / "spec.toml", "--out", tmp_path / "out", "--json", tmp_path / "j")
    assert code == 0
    assert ": 3 records of 3 files (" in shown
    names = ["dead (x, y)", "gone (x, y)", "half (x)"]
    assert message == f"3 without a signal, as if the sensor were not connected: {', '.join(names)}\n"
    assert json.loads((tmp_path / "j").read_text())["dead"] == names
    with Corpus(tmp_path / "out") as corpus:
        stored = [json.loads(str(corpus.waveform(record, "provenance"))).get("no_signal") for record in range(3)]
    assert stored == [["x", "y"], ["x", "y"], ["x"]]
    assert run("check", tmp_path / "out")[0] == 0


@pytest.mark.parametrize(
    ("said", "lines"),
    [
        ('bearing = "skf_6205"\nspeed_rpm = 1797', []),
        ("bpfo = 3.58\nbpfi = 5.42\nspeed_rpm = 1797", []),
        ("bpfo = 3.58\nspeed_rpm = 1797", ["`classify` will reject 2 of them: geometry unknown"]),
        ('bearing = "skf_6205"', ["`classify` will reject 2 of them: speed unknown"]),
        (
            'speed_rpm = 0\n[[recording.override]]\nfiles = "b.mat"\nspeed_rpm = 1797',
            [
                "`classify` will reject 1 of them: speed not above 0",
                "`classify` will reject 1 of them: geometry unknown",
            ],
        ),
    ],
)
def test_records_that_say_too_little_to_be_judged_are_counted(
    said: str, lines: list[str], mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    mat("b.mat")
    (tmp_path / "spec.toml").write_text(f'{DOUBTED}files = "*.mat"\nrate_hz = 1000\ny = "sig"\n{said}\n')
    code, shown, _ = run("import", tmp_path / "spec.toml", "--out", tmp_path / "out")
    assert code == 0
    assert shown.splitlines()[1:] == lines


DOUBTED = 'name = "mine"\n[[recording]]\nname = "all"\nunit = "g"\n'


def told_of(settings: str, tmp_path: Path) -> str:
    """What the import of recordings with these settings says on standard error."""
    (tmp_path / "spec.toml").write_text(DOUBTED + settings)
    code, _, message = run("import", tmp_path / "spec.toml", "--out", tmp_path / "out")
    assert code == 0
    assert run("check", tmp_path / "out")[0] == 0
    return message


@pytest.mark.parametrize(
    ("level", "mean", "message"),
    [
        (659.0, 0.0, "1 louder than machines are, as if `scale` or `unit` were wrong: a (y 659 g RMS)\n"),
        (99.0, 0.0, ""),
        (65.0, -80.0, "1 louder than machines are, as if `scale` or `unit` were wrong: a (y 103 g RMS)\n"),
        (58.0, -80.0, ""),  # 98.8 g together
        (0.5, 5.5, "1 with a mean above 10 times the vibration around it, as of gravity or a sensor's bias: "
                   "a (y 5.5 g beside 0.5 g RMS)\n"),
        (0.5, -5.5, "1 with a mean above 10 times the vibration around it, as of gravity or a sensor's bias: "
                   "a (y -5.5 g beside 0.5 g RMS)\n"),
        (0.5, -4.5, ""),
    ],
)  # fmt: skip
def test_a_level_that_hardly_any_machine_has_comes_in_with_a_warning(
    level: float, mean: float, message: str, mat: Mat, tmp_path: Path
) -> None:
    signal = noise()
    mat("a.mat", mean + level * (signal - signal.mean()) / signal.std())
    assert told_of('files = "*.mat"\nrate_hz = 1000\ny = "sig"\n', tmp_path) == message


@pytest.mark.parametrize(
    ("limit", "steps", "message"),
    [
        (1.0, 0, "1 with peaks cut off, as if the recorder's range were too small: a (y 0.055 of its samples)\n"),
        (9.0, 0, ""),
        (1.0, 4, ""),  # few values, as of a quiet signal in coarse steps, often have two alike
    ],
)
def test_peaks_that_a_recorder_cut_off_come_in_with_a_warning(
    limit: float, steps: int, message: str, mat: Mat, tmp_path: Path
) -> None:
    cut_off = np.clip(noise(), -limit, limit)
    mat("a.mat", np.round(cut_off * steps) if steps else cut_off)
    assert told_of('files = "*.mat"\nrate_hz = 1000\ny = "sig"\n', tmp_path) == message


HELD = "1 with a stretch of one value, as if padded or the signal lost; from_s and to_s take what is beside it: "


@pytest.mark.parametrize(
    ("value", "start", "stop", "message"),
    [
        (0.0, 1000, 4000, HELD + "a (y 3000 of 4000 samples)\n"),
        (0.3, 100, 300, HELD + "a (y 200 of 4000 samples)\n"),
        (0.3, 100, 190, ""),
    ],
)
def test_a_signal_that_stands_still_for_long_comes_in_with_a_warning(
    value: float, start: int, stop: int, message: str, mat: Mat, tmp_path: Path
) -> None:
    signal = noise(4000)
    signal[start:stop] = value
    mat("a.mat", signal)
    assert told_of('files = "*.mat"\nrate_hz = 1000\ny = "sig"\n', tmp_path) == message


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_times_taken_for_a_vibration_come_in_with_a_warning(sign: float, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat", noise(), data=np.stack([sign * np.arange(400) / 1000.0, noise()], axis=1))
    told = told_of('files = "*.mat"\nrate_hz = 1000\ny = "data[:,0]"\n', tmp_path)
    assert told == "1 with samples that only rise or only fall, as times or an angle do and no vibration: a (y)\n"


@pytest.mark.parametrize(
    ("period", "steps", "message"),
    [
        (1500, 0, "a (y after 1500 samples)\n"),
        (3950, 0, ""),  # too few samples are left
        (100, 3, ""),  # of few values
    ],
)
def test_a_buffer_written_twice_comes_in_with_a_warning(
    period: int, steps: int, message: str, mat: Mat, tmp_path: Path
) -> None:
    signal = np.resize(noise(period), 4000)
    mat("a.mat", np.round(signal * steps) if steps else signal)
    told = told_of('files = "*.mat"\nrate_hz = 1000\ny = "sig"\n', tmp_path)
    assert told.endswith(f": {message}" if message else "")
    assert ("comes again exactly" in told) == bool(message)


SLOW = "1 with a shaft slower than 100 rpm, as if `{}` were in Hz: a ({} rpm)\n"


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("speed_hz = 1797", "1 with a shaft faster than 60000 rpm, as if `speed_hz` were in rpm: a (107820 rpm)\n"),
        ("speed_rpm = 107820", "1 with a shaft faster than 60000 rpm: a (107820 rpm)\n"),
        ("speed_hz = 29.95", ""),
        ("speed_rpm = 29.95", SLOW.format("speed_rpm", "29.95")),
        ("nominal_speed_rpm = 29.95", SLOW.format("nominal_speed_rpm", "29.95")),
        ("speed_rpm = 101", ""),
        ("speed_hz = 0.5", ""),
    ],
)
def test_a_speed_that_hardly_any_machine_has_comes_in_with_a_warning(
    setting: str, message: str, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat", noise(30_000))
    assert told_of(f'files = "*.mat"\nrate_hz = 1000\ny = "sig"\n{setting}\n', tmp_path) == message


@pytest.mark.parametrize(
    ("ball", "pitch", "message"),
    [
        (0.3126, 1.537, "1 with a bearing of less than 4 mm pitch diameter, as if in inches: a (1.537 mm)\n"),
        (7.94, 39.04, ""),
    ],
)
def test_a_bearing_stated_in_inches_comes_in_with_a_warning(
    ball: float, pitch: float, message: str, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    bearing = f"bearing = {{balls = 9, ball_diameter_mm = {ball}, pitch_diameter_mm = {pitch}}}\n"
    assert told_of(f'files = "*.mat"\nrate_hz = 1000\ny = "sig"\n{bearing}', tmp_path) == message


@pytest.mark.parametrize(
    ("orders", "message"),
    [
        # A 6203 at 25 Hz: 3.0544 and 4.9456 orders.
        (
            "bpfo = 76.36\nbpfi = 123.64\n",
            "1 with a bearing of more than 60 balls, as if `bpfo` and `bpfi` were in Hz: a (200 balls)\n",
        ),
        ("bpfo = 27.1\nbpfi = 32.9\n", ""),
        (
            "bpfo = 27.1\nbpfi = 33.9\n",
            "1 with a bearing of more than 60 balls, as if `bpfo` and `bpfi` were in Hz: a (61 balls)\n",
        ),
        # One order alone: there are more balls than twice BPFO, and than BPFI.
        (
            "bpfo = 76.36\n",
            "1 with a bearing of more than 60 balls, as if `bpfo` and `bpfi` were in Hz: a (152.7 balls)\n",
        ),
        (
            "bpfi = 123.64\n",
            "1 with a bearing of more than 60 balls, as if `bpfo` and `bpfi` were in Hz: a (123.6 balls)\n",
        ),
        ("bpfo = 29.9\n", ""),
        ("bpfi = 59.9\n", ""),
        ("bearing = {balls = 64, ball_diameter_mm = 8, pitch_diameter_mm = 300}\n", ""),
    ],
)
def test_orders_that_may_be_in_hz_come_in_with_a_warning(orders: str, message: str, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    assert told_of(f'files = "*.mat"\nrate_hz = 1000\ny = "sig"\n{orders}', tmp_path) == message


@pytest.mark.parametrize(
    ("extent_mm", "message"),
    [
        (0, ""),
        (0.007, "1 with a defect shorter than 0.02 mm, as if `extent_mm` were in inches or m: a (0.007 mm)\n"),
        (0.021, ""),
    ],
)
def test_a_defect_shorter_than_anybody_measures_comes_in_with_a_warning(
    extent_mm: float, message: str, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    bearing = "bearing = {balls = 9, ball_diameter_mm = 7.94, pitch_diameter_mm = 39.04}\n"
    defect = f'location = "outer"\nextent_mm = {extent_mm}\n' if extent_mm else 'location = "none"\n'
    assert told_of(f'files = "*.mat"\nrate_hz = 1000\ny = "sig"\n{bearing}{defect}', tmp_path) == message


@pytest.mark.parametrize(
    ("kind", "scale", "message"),
    [
        (np.int16, "", "1 in whole numbers of .wav without `scale`, taken as ±1 g at full scale: a\n"),
        (np.uint8, "", "1 in whole numbers of .wav without `scale`, taken as ±1 g at full scale: a\n"),
        (np.int16, "scale = 1.0\n", ""),
        (np.float32, "", ""),
    ],
)
def test_a_wave_file_whose_full_scale_is_not_stated_comes_in_with_a_warning(
    kind: type, scale: str, message: str, tmp_path: Path
) -> None:
    size, middle = {np.int16: (1000.0, 0.0), np.uint8: (20.0, 128.0), np.float32: (1.0, 0.0)}[kind]
    counts = (middle + size * noise()).astype(kind)
    wavfile.write(tmp_path / "a.wav", 1000, counts)
    assert told_of(f'files = "*.wav"\ny = "data"\n{scale}', tmp_path) == message


TURNS = "the shortest record, a, holds {} turns of the shaft{}\n"


@pytest.mark.parametrize(
    ("speed", "message"),
    [
        ("speed_rpm = 24.5", TURNS.format("0.16", ": is speed_rpm in Hz?")),
        ("nominal_speed_rpm = 24.5", TURNS.format("0.16", ": is nominal_speed_rpm in Hz?")),
        ("speed_rpm = 1400", TURNS.format("9.3", "")),
        ("speed_hz = 4", TURNS.format("1.6", "")),
        ("speed_rpm = 1600", ""),
        ("speed_rpm = 0", ""),
        ("", ""),
    ],
)
def test_a_record_in_which_the_shaft_hardly_turns_comes_in_with_a_warning(
    speed: str, message: str, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat", noise(400))
    mat("b.mat", noise(500, seed=1))
    assert told_of(f'files = "*.mat"\nrate_hz = 1000\ny = "sig"\n{speed}\n', tmp_path) == message


@pytest.mark.parametrize(("plateau", "doubted"), [(11, False), (12, True)])
def test_a_thousandth_of_the_samples_may_follow_another_at_the_limits(
    plateau: int, doubted: bool, mat: Mat, tmp_path: Path
) -> None:
    signal = noise(10_000)
    signal[500 : 500 + plateau] = 9.0
    mat("a.mat", signal)
    assert ("peaks cut off" in told_of('files = "*.mat"\nrate_hz = 1000\ny = "sig"\n', tmp_path)) == doubted


@pytest.mark.parametrize(("length", "doubted"), [(200, False), (201, True)])
def test_a_hundredth_of_a_long_signal_may_stand_still(length: int, doubted: bool, mat: Mat, tmp_path: Path) -> None:
    signal = noise(20_000)
    signal[500 : 500 + length] = 0.3
    mat("a.mat", signal)
    assert ("stretch of one value" in told_of('files = "*.mat"\nrate_hz = 1000\ny = "sig"\n', tmp_path)) == doubted

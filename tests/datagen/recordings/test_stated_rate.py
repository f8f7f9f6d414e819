"""A stated sampling rate beside one that the file itself tells."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from command_line import run
from imports import Mat

SPEC = 'name = "mine"\n[[recording]]\nname = "all"\nfiles = "a.*"\nunit = "g"\nrate_hz = 25600\n'
ANOTHER = "1 with another sampling rate in the file than the stated one: a (25600 Hz stated, "
TIMES = np.arange(400.0)


def told(tmp_path: Path, settings: str) -> str:
    """What the import says on standard error."""
    (tmp_path / "spec.toml").write_text(SPEC + settings)
    code, _, message = run("import", tmp_path / "spec.toml", "--out", tmp_path / "out")
    assert code == 0
    return message


@pytest.mark.parametrize(
    ("held", "figures"),
    [
        ({"fs": 12000.0}, "12000 by fs)\n"),
        ({"bearing": {"sr": 48828.0}}, "48828 by bearing.sr)\n"),
        ({"Sampling_Rate_Hz": np.int32(12000)}, "12000 by Sampling_Rate_Hz)\n"),
        ({"Fs": 12.0}, "12 by Fs)\n"),
        ({"fs": 25900.0}, "25900 by fs)\n"),
        ({"fs": 25.6e6}, "2.56e+07 by fs)\n"),  # no unit of a rate is smaller than Hz
        ({"time": TIMES / 12000.0}, "12000 by time)\n"),
        ({"t_ms": TIMES[:, None] / 12.0}, "12 by t_ms)\n"),
    ],
)
def test_a_file_that_tells_another_rate_comes_in_with_a_warning(
    held: dict[str, object], figures: str, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat", **held)
    assert told(tmp_path, 'y = "sig"\n') == ANOTHER + figures


@pytest.mark.parametrize(
    "held",
    [
        {"fs": 25600.0},
        {"fs": 25.6},  # kHz
        {"fs": 25400.0},
        {"rate": 29.95, "fs": np.array([12000.0, 48000.0])},  # of the shaft, as in MFPT; of several channels
        {"time": np.round(TIMES / 25600.0, 4)},
        {"t_us": np.round(TIMES / 0.0256)},
        {"time": TIMES},  # the number of the sample
        {"time": TIMES[:50] / 50.0, "times": np.sqrt(TIMES)},  # of another channel; not even
        {"time": 0.0, "fs": -1.0},
        {"time": np.where(TIMES == 7.0, np.nan, TIMES / 12000.0)},
    ],
)
def test_a_file_that_tells_the_same_rate_or_none_comes_in_without(
    held: dict[str, object], mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat", **held)
    assert told(tmp_path, 'y = "sig"\n') == ""


@pytest.mark.parametrize(("step", "message"), [(1 / 25600, ""), (1 / 51200, ANOTHER + "51200 by 1)\n")])
def test_the_first_column_of_a_table_without_header_may_be_its_clock(step: float, message: str, tmp_path: Path) -> None:
    signal = np.random.default_rng(0).standard_normal(400)
    (tmp_path / "a.csv").write_text("".join(f"{k * step:.7f},{value}\n" for k, value in enumerate(signal)))
    assert told(tmp_path, 'y = "2"\ncsv = {header = false}\n') == message


def test_the_rate_that_is_read_from_the_file_is_not_doubted(mat: Mat, tmp_path: Path) -> None:
    mat("a.mat", fs=12000.0, true=25600.0)
    (tmp_path / "spec.toml").write_text(SPEC.replace("25600", '{variable = "true"}') + 'y = "sig"\n')
    assert run("import", tmp_path / "spec.toml", "--out", tmp_path / "out")[::2] == (0, "")


def test_a_variable_that_is_called_1_is_no_clock(tmp_path: Path) -> None:
    np.savez(tmp_path / "a.npz", **{"1": TIMES / 12000.0, "2": np.random.default_rng(0).standard_normal(400)})
    assert told(tmp_path, 'y = "2"\n') == ""


def test_the_times_of_a_recording_that_is_cut_are_looked_at_whole(mat: Mat, tmp_path: Path) -> None:
    mat("a.mat", time=TIMES / 12000.0)
    expected = "2 with another sampling rate in the file than the stated one: " + ", ".join(
        f"a#{piece} (25600 Hz stated, 12000 by time)" for piece in (0, 1)
    )
    assert told(tmp_path, 'y = "sig"\ncut_s = 0.0078125\n') == f"{expected}\n"

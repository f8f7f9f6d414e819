"""Sampling rates of files that hold times: a column of them, rounded as they may be, or the step between two."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray
from imports import Bring, Mat

from datagen.errors import BadInput
from datagen.recordings.sample_times import rate_of

SPEC = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\ny = "sig"\n'


@pytest.mark.parametrize(
    "setting",
    [
        '{variable = "seconds", times = true}',
        '{variable = "ticks", times = true, factor = 1e-6}',
        '{variable = "step", times = true}',
    ],
)
def test_a_rate_follows_from_times_or_their_step(setting: str, bring: Bring, mat: Mat) -> None:
    ticks = 7 + np.arange(400) * 40
    mat("a.mat", seconds=ticks[:, None] * 1e-6, ticks=ticks.astype(np.int32), step=4e-5)
    corpus = bring(f"{SPEC}rate_hz = {setting}\n")
    assert corpus.labels[["rate_hz", "duration_s"]].to_numpy().tolist() == [[25000.0, 0.016]]


def test_rounded_times_give_the_rate_as_well_as_their_ends_say() -> None:
    times = np.arange(25_600) / 25_600.0
    assert rate_of(times.round(3), Path("a.csv"), "t") == pytest.approx(25_600.0, rel=1e-3)


def test_a_rate_is_no_rounder_than_its_rounded_times_allow() -> None:
    # Known to half a microsecond at both ends of 1000 samples, a step of 83 µs leaves less than 0.3 Hz of doubt.
    assert rate_of((np.arange(1000) / 12_001.0).round(6), Path("a.csv"), "t") == 12_001.0


def test_a_rate_is_as_round_as_times_allow_that_are_rounded_at_both_ends() -> None:
    assert rate_of((1.23456 + np.arange(128) / 12_000.0).round(4), Path("a.csv"), "t") == 12_000.0


@pytest.mark.parametrize("start", [0.0, 3.5e-5, 12.345, 1.7e9])
@pytest.mark.parametrize("rate", [12_000.0, 25_600.0, 48_828.125])
def test_rounded_times_of_all_files_of_a_set_give_one_rate(start: float, rate: float) -> None:
    times = (start + np.arange(60_000) / rate).round(6)
    assert rate_of(times, Path("a.csv"), "t") == pytest.approx(rate, rel=0.0 if rate < 48_000.0 else 5e-6)


@pytest.mark.parametrize("rate", [12_000.0, 25_617.25, 48_828.125])
def test_exact_times_give_every_digit_of_a_rate(rate: float) -> None:
    assert rate_of(np.arange(60_000) / rate, Path("a.npy"), "t") == rate


@pytest.mark.parametrize(
    ("times", "message"),
    [
        (np.concatenate([np.arange(200), np.arange(260, 460)]) * 1e-3, "these times are not evenly spaced"),
        (np.arange(400)[::-1] * 1e-3, "is not a column of rising times; allowed: times or their step, s"),
        (np.zeros(400), "is not a column of rising times"),
        (np.zeros((200, 2)), "is not a column of rising times"),
        (-0.5, "is not a column of rising times"),
        (1.0, "rate_hz = 1.0: from the variable t, whose times are read as s; allowed: a number from 100 to 1e+07"),
    ],
    ids=["a gap", "falling", "still", "two columns", "a step back", "too slow"],
)
def test_times_that_give_no_rate_are_refused(
    times: object, message: str, bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat", t=times)
    with pytest.raises(BadInput) as problem:
        bring(SPEC + 'rate_hz = {variable = "t", times = true}\n')
    assert str(problem.value).startswith(f"{tmp_path / 'a.mat'}: rate_hz = ")
    assert message in str(problem.value)


@pytest.mark.parametrize(("size", "off"), [(400, 1.5), (4000, 3.5), (400, 2.5), (4000, 4.5)])
def test_times_may_lie_two_steps_off_a_straight_line_or_a_thousandth_of_their_span(size: int, off: float) -> None:
    times = np.arange(float(size))
    times[size // 2] += off
    if off < max(2.0, 1e-3 * size):
        assert rate_of(times * 1e-3, Path("a.csv"), "t") == pytest.approx(1000.0)
    else:
        with pytest.raises(BadInput, match="not evenly spaced"):
            rate_of(times * 1e-3, Path("a.csv"), "t")


def test_a_time_column_in_place_of_a_rate_comes_with_a_way_out(bring: Bring, mat: Mat) -> None:
    mat("a.mat", t=np.arange(400) * 1e-3)
    with pytest.raises(BadInput, match=r'rate_hz = "t": holds 400 numbers from .*; allowed: .* times = true'):
        bring(SPEC + 'rate_hz = {variable = "t"}\n')
    with pytest.raises(BadInput, match=r"recording\[1\]\.load_n\.times.*: times can only give a sampling rate"):
        bring(SPEC + 'rate_hz = 1000\nload_n = {variable = "t", times = true}\n')


def test_times_in_nanoseconds_need_a_factor(bring: Bring, tmp_path: Path) -> None:
    start = np.datetime64("2024-03-01T12:00:00", "ns")
    times = start + np.arange(400) * np.timedelta64(62_500, "ns")
    samples = np.random.default_rng(1).standard_normal(400)
    xarray.Dataset({"sig": ("time", samples)}, {"time": times}).to_netcdf(tmp_path / "a.nc")
    spec = SPEC.replace("a.mat", "a.nc") + 'rate_hz = {variable = "time", times = true}\n'
    with pytest.raises(BadInput, match=r"rate_hz = 1\.6e-05: from .* are read as s; .*; factor brings times to s"):
        bring(spec)
    assert bring(spec.replace("true", "true, factor = 1e-9")).labels["rate_hz"].tolist() == [16000.0]


def test_dates_in_place_of_times_come_with_a_way_out(bring: Bring, tmp_path: Path) -> None:
    times = np.datetime64("2024-03-01", "ns") + np.arange(400) * np.timedelta64(40_000, "ns")
    np.savez(tmp_path / "a.npz", sig=np.arange(400.0), time=times)
    with pytest.raises(BadInput, match=r'rate_hz = "time": is not a finite number; allowed: times in s; of dates'):
        bring(SPEC.replace("a.mat", "a.npz") + 'rate_hz = {variable = "time", times = true}\n')


def test_hours_of_a_clock_in_place_of_times_come_with_a_way_out(bring: Bring, tmp_path: Path) -> None:
    rows = (f"2024-03-01T12:00:00.{k:06d},{k % 7}" for k in range(40))
    (tmp_path / "a.csv").write_text("\n".join(["t,a", *rows]))
    with pytest.raises(
        BadInput, match=r'the first is "2024-03-01T12:00:00\.000000"; allowed: times in s; of dates and'
    ):
        bring(
            '[[recording]]\nname = "all"\nfiles = "a.csv"\nunit = "g"\ny = "a"\n'
            'rate_hz = {variable = "t", times = true}\n'
        )


def test_a_rate_has_nine_digits_at_most() -> None:
    assert rate_of(np.arange(60_000) / (25_600.0 / 3.0), Path("a.npy"), "t") == 8533.33333


def test_a_step_that_no_rate_has_is_refused() -> None:
    with pytest.raises(BadInput, match="is not a column of rising times"):
        rate_of(np.array([1e-320]), Path("a.npy"), "t")

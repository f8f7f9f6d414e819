"""Samples that are missing: refused, or filled where the gap is short and the SPEC asks for it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from imports import Bring, Mat
from scipy.signal import lfilter

from datagen.errors import BadInput

GAPS = '[[recording]]\nname = "all"\nfiles = "*.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'


@pytest.mark.parametrize("gaps", [{7}, set(range(100, 110)), {50, 51, 399}])
def test_short_gaps_are_filled_if_that_is_asked_for(bring: Bring, mat: Mat, gaps: set[int]) -> None:
    line = np.linspace(1.0, 2.0, 2000)
    mat("a.mat", np.where(np.isin(np.arange(2000), list(gaps)), np.nan, line))
    with pytest.raises(BadInput, match=r'are not finite numbers.*allowed: finite numbers, or missing_samples = "fill"'):
        bring(GAPS, "refused")
    corpus = bring(GAPS + 'missing_samples = "fill"\n', "filled")
    np.testing.assert_allclose(corpus.waveform(0)[:, 0], 9.80665 * line, rtol=1e-6)
    assert json.loads(corpus.waveform(0, "provenance"))["mended_samples"] == len(gaps)


def test_what_is_filled_is_counted_over_all_axes(bring: Bring, mat: Mat) -> None:
    x, y = np.random.default_rng(2).standard_normal((2, 2000))
    x[7] = y[[20, 300]] = np.nan
    mat("a.mat", y, other=x)
    corpus = bring(GAPS + 'x = "other"\nmissing_samples = "fill"\n')
    assert json.loads(corpus.waveform(0, "provenance"))["mended_samples"] == 3


def test_a_filled_vibration_goes_on_in_its_gaps(bring: Bring, mat: Mat) -> None:
    draws = np.random.default_rng(3)
    ringing = lfilter([1.0], [1.0, -1.2, 0.9], draws.standard_normal(20_000))  # a resonance at 0.14 of the rate
    gaps = (draws.choice(2000, 20, replace=False)[:, None] * 10 + np.arange(8)).ravel()
    gaps = np.concatenate([[0, 1], gaps[gaps > 9], [19_999]])
    mat("a.mat", np.where(np.isin(np.arange(20_000), gaps), np.nan, ringing))
    filled = bring(GAPS + 'missing_samples = "fill"\n').waveform(0)[:, 0] / 9.80665
    untouched = np.delete(np.arange(20_000), gaps)
    np.testing.assert_allclose(filled[untouched], ringing[untouched], rtol=1e-6)
    assert np.std((filled - ringing)[gaps]) < 0.6 * np.std(ringing)  # straight lines are off by 1.2 times it


@pytest.mark.parametrize("gaps", [range(100, 111), range(0, 2000, 60), range(0, 2000, 96)])
def test_long_and_many_gaps_are_refused(bring: Bring, mat: Mat, gaps: range) -> None:
    signal = np.random.default_rng(1).standard_normal(2000)
    signal[list(gaps)] = np.nan
    mat("a.mat", signal)
    with pytest.raises(BadInput, match=rf"{len(gaps)} of 2000 samples.*at most 10 in a row and 1% of all"):
        bring(GAPS + 'missing_samples = "fill"\n')


def test_text_in_a_table_is_no_gap(bring: Bring, tmp_path: Path) -> None:
    cells = [f"{value:.3f}" for value in np.random.default_rng(1).standard_normal(2000)]
    spec = GAPS.replace("*.mat", "a.csv") + 'missing_samples = "fill"\n'
    (tmp_path / "a.csv").write_text("\n".join(["sig", *cells[:50], "stop", *cells[50:]]))
    with pytest.raises(BadInput, match=r'line 52: y = "sig": 1 of 2001 cells .* the first is "stop"'):
        bring(spec)
    rows = [f"{cell},1" for cell in [*cells[:50], "NaN", *cells[50:]]]
    (tmp_path / "a.csv").write_text("\n".join(["sig,b", *rows]))
    assert bring(spec, "filled").waveform(0).shape == (2001, 1)


def test_text_behind_a_gap_is_no_gap_either(bring: Bring, tmp_path: Path) -> None:
    cells = [f"{value:.3f}" for value in np.random.default_rng(1).standard_normal(2000)]
    rows = [f"{cell},1" for cell in [*cells[:50], "", *cells[50:60], "stop", *cells[60:]]]
    (tmp_path / "a.csv").write_text("\n".join(["sig,b", *rows]))
    with pytest.raises(BadInput, match=r'line 63: y = "sig": 2 of 2002 cells .* one of them is "stop"'):
        bring(GAPS.replace("*.mat", "a.csv") + 'missing_samples = "fill"\n')


BLANK = 'y = "sig": 3 of 2003 cells are not finite numbers, the first is ""; allowed: finite numbers, or missing'


@pytest.mark.parametrize("end", ["", "\n", "\n\n\n"])
def test_blank_lines_within_a_single_column_are_missing_samples(end: str, bring: Bring, tmp_path: Path) -> None:
    cells = [f"{value:.3f}" for value in np.random.default_rng(1).standard_normal(2000)]
    spec = GAPS.replace("*.mat", "a.csv")
    (tmp_path / "a.csv").write_text("\n".join(["sig", *cells[:50], "", "", "", *cells[50:]]) + end)
    with pytest.raises(BadInput, match=f"a\\.csv, line 52: {BLANK}"):
        bring(spec)
    corpus = bring(spec + 'missing_samples = "fill"\n', "filled")
    assert corpus.waveform(0).shape == (2003, 1)
    assert json.loads(corpus.waveform(0, "provenance"))["mended_samples"] == 3


@pytest.mark.parametrize("layout", ["", "csv = {header = false}\n"])
def test_blank_lines_around_a_single_column_are_no_samples(layout: str, bring: Bring, tmp_path: Path) -> None:
    cells = [f"{value:.3f}" for value in np.random.default_rng(1).standard_normal(2000)]
    head = ["", ""] if layout else ["", "sig", ""]
    (tmp_path / "a.csv").write_text("\n".join([*head, *cells, "", "", ""]))
    spec = GAPS.replace("*.mat", "a.csv")
    assert bring((spec.replace('"sig"', '"1"') if layout else spec) + layout).waveform(0).shape == (2000, 1)


@pytest.mark.parametrize(("missing", "advised"), [(10, True), (11, False)])
def test_filling_is_advised_where_it_would_do_alone(missing: int, advised: bool, bring: Bring, mat: Mat) -> None:
    mat("a.mat", np.where(np.arange(2000) < missing, np.nan, np.sin(np.arange(2000.0))))
    with pytest.raises(BadInput, match=f"{missing} of 2000 samples are not finite") as refused:
        bring(GAPS)
    assert ("missing_samples" in str(refused.value)) is advised

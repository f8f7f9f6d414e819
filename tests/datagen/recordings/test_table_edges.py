"""Text tables as loggers export them: a line of units below the names, delimiters at the ends of some lines only."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from imports import Bring

from datagen.errors import BadInput
from datagen.formats.csv_layout import CsvLayout
from datagen.formats.reading import read_arrays

SPEC = '[[recording]]\nname = "all"\nfiles = "a.csv"\nunit = "m/s2"\nrate_hz = 1000\ny = "acc Y"\n'
CELLS = np.random.default_rng(5).standard_normal((120, 2)).round(4)
ROWS = [f"{first};{second}" for first, second in CELLS]
SEMICOLON = CsvLayout(delimiter=";")


@pytest.mark.parametrize("units", [["s;m/s²"], ["s;m/s²", ""], ["s;m/s²", "1;2"]])
@pytest.mark.parametrize("gap", [False, True])
def test_lines_below_the_names_are_left_out(units: list[str], gap: bool, bring: Bring, tmp_path: Path) -> None:
    rows = [";", *ROWS[1:]] if gap else ROWS
    (tmp_path / "a.csv").write_text("\n".join(["t;acc Y", *units, *rows]).replace(".", ","), encoding="utf-8-sig")
    below = sum(bool(line) for line in units)
    layout = f'csv = {{delimiter = ";", decimal = ",", skip_below = {below}}}\nmissing_samples = "fill"\n'
    samples = bring(SPEC + layout).waveform(0, "acceleration")[:, 0]
    assert samples[1:].tolist() == CELLS[1:, 1].astype(np.float32).tolist()
    assert samples.size == 120


def test_blank_lines_between_units_and_numbers_of_a_single_column_are_no_samples(bring: Bring, tmp_path: Path) -> None:
    cells = [*map(str, CELLS[:, 0])]
    (tmp_path / "a.csv").write_text("\n".join(["acc Y", "", "m/s²", "", *cells[:60], "", *cells[61:]]))
    samples = bring(SPEC + 'csv = {skip_below = 1}\nmissing_samples = "fill"\n').waveform(0, "acceleration")[:, 0]
    assert np.delete(samples, 60).tolist() == np.delete(CELLS[:, 0], 60).astype(np.float32).tolist()


def test_a_line_of_units_that_is_not_left_out_comes_with_the_way_to_do_so(bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join(["t;acc Y", "s;g", *ROWS]))
    message = r'the first is "g"; did you mean csv = \{skip_below = 1\}\?'
    with pytest.raises(BadInput, match=message):
        bring(SPEC + 'csv = {delimiter = ";"}\n')


@pytest.mark.parametrize("rows", [["s;g", "-;x", *ROWS], [ROWS[0], "-;x", *ROWS], ["s;", *ROWS, "-;"]])
def test_cells_that_are_no_line_of_units_are_not_called_one(rows: list[str], bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join(["t;acc Y", *rows]))
    with pytest.raises(BadInput) as refused:
        bring(SPEC + 'csv = {delimiter = ";"}\n')
    assert "cells are not finite numbers" in str(refused.value)
    assert "did you mean" not in str(refused.value)


def test_there_is_no_line_below_names_that_are_not_there(bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join(ROWS))
    with pytest.raises(BadInput, match=r"recording\[1\]\.csv\.skip_below.*there is no header.*skip_lines"):
        bring(SPEC + "csv = {header = false, skip_below = 1}\n")


@pytest.mark.parametrize("empty", [0, 1])
@pytest.mark.parametrize(("head_end", "row_end"), [("", ";"), (";", ""), ("; ", "")])
def test_a_delimiter_that_ends_the_header_alone_or_the_rows_alone_makes_no_column(
    head_end: str, row_end: str, empty: int, tmp_path: Path
) -> None:
    rows = ["1;" if k < empty else row for k, row in enumerate(ROWS)]
    (tmp_path / "a.csv").write_text("\n".join([f"t;acc Y{head_end}", *(row + row_end for row in rows)]))
    columns = read_arrays(tmp_path / "a.csv", None, SEMICOLON)
    assert list(columns) == ["t", "acc Y"]
    assert columns["acc Y"][empty:].tolist() == CELLS[empty:, 1].tolist()


@pytest.mark.parametrize(
    ("head", "rows"),
    [
        ("t;acc Y", [f"{k};{row}" for k, row in enumerate(ROWS)]),
        ("t;acc Y;remark", ROWS),
        ("t;acc Y", [*(row + ";" for row in ROWS), "0;0"]),
        ("t;acc Y", [row + ";;" for row in ROWS]),
        ("t;acc Y", [*(row + ";" for row in ROWS), "0;0;;"]),
    ],
    ids=["numbers of rows", "a name too many", "one row without", "two", "one row with two"],
)
def test_a_table_whose_names_and_cells_do_not_match_is_refused(head: str, rows: list[str], tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join([head, *rows]))
    with pytest.raises(BadInput, match=r"a\.csv, line \d+: \d cells, but the table has \d columns.*; allowed: as many"):
        read_arrays(tmp_path / "a.csv", None, SEMICOLON)


@pytest.mark.parametrize("sign", ["tab", "", "\\\\t"])
@pytest.mark.parametrize("setting", ["delimiter", "decimal"])
def test_a_sign_is_one_character(setting: str, sign: str, bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join(ROWS))
    with pytest.raises(BadInput) as refused:
        bring(SPEC + f'csv = {{{setting} = "{sign}"}}\n')
    assert str(refused.value).endswith(r'allowed: one character, such as ";", or "\t" for a tabulator')


def test_a_number_in_the_first_row_alone_is_taken_from_there(bring: Bring, tmp_path: Path) -> None:
    rows = [f"{cell};{'29.5' * (k == 0)}" for k, cell in enumerate(CELLS[:, 0])]
    (tmp_path / "a.csv").write_text("\n".join(["acc Y;Speed (Hz)", *rows]))
    spec = SPEC + 'csv = {delimiter = ";"}\nspeed_hz = {variable = "Speed (Hz)"}\n'
    message = (
        'line 3: speed_hz = "Speed (Hz)": 119 of 120 cells are not finite numbers, the first is ""; allowed: a single'
    )
    with pytest.raises(BadInput, match=re.escape(message)):
        bring(spec)
    assert bring(spec.replace("(Hz)", "(Hz)[0]")).labels["speed_rpm"].tolist() == [1770.0]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
@pytest.mark.parametrize("end", ["\x1a", "\n\x1a", "\r\n\x1a\0\0\0", "\0\r\n", "\n\0\0"])
def test_ctrl_z_and_zeros_at_the_end_of_a_table_are_no_matter(end: str, encoding: str, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join(["t;acc Y", *ROWS]) + end, encoding=encoding, newline="")
    columns = read_arrays(tmp_path / "a.csv", None, CsvLayout(delimiter=";", encoding=encoding))
    assert np.stack([columns["t"], columns["acc Y"]], axis=1).tolist() == CELLS.tolist()


@pytest.mark.parametrize("sign", ["\x1a", "\0"])
def test_ctrl_z_and_zeros_within_a_table_are_refused(sign: str, bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join(["t;acc Y", *ROWS[:60], f"0;{sign}1", *ROWS[60:]]) + "\n")
    with pytest.raises(BadInput, match=r'a\.csv, line 62: y = "acc Y": 1 of 121 cells are not finite numbers'):
        bring(SPEC + 'csv = {delimiter = ";"}\n')


@pytest.mark.parametrize("word", ["nan", "inf", "-Infinity"])
def test_a_word_that_python_takes_for_a_number_is_told_with_its_line(word: str, bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join(["t;acc Y", *ROWS[:60], f"0;{word}", *ROWS[60:]]) + "\n")
    message = rf'a\.csv, line 62: y = "acc Y": 1 of 121 cells are not finite numbers, the first is "{word}"'
    with pytest.raises(BadInput, match=message):
        bring(SPEC + 'csv = {delimiter = ";"}\n')

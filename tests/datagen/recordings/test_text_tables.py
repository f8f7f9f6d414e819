"""Text tables in other encodings than UTF-8, and such as hold more than numbers."""

from __future__ import annotations

import gzip
import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from imports import Bring, refusal

from datagen.errors import BadInput
from datagen.files.csv_rows import Row, read_csv_rows
from datagen.formats.csv_file import read_csv
from datagen.formats.csv_layout import CsvLayout
from datagen.formats.reading import read_arrays

SPEC = '[[recording]]\nname = "all"\nfiles = "a.csv"\nunit = "g"\nrate_hz = 1000\ny = "a"\n'
CELLS = np.random.default_rng(5).standard_normal((50, 2)).tolist()
ROWS = [f"{first!r},{second!r}" for first, second in CELLS]


@pytest.mark.parametrize("encoding", ["latin-1", "utf-16"])
def test_a_table_in_another_encoding_is_read_once_it_is_stated(encoding: str, bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join(["a,T (°C)", *ROWS]), encoding=encoding)
    message = r'a\.csv: csv\.encoding = "utf-8": is not text in this encoding; allowed: the encoding of the file'
    with pytest.raises(BadInput, match=message):
        bring(SPEC)
    assert len(bring(SPEC + f'csv = {{encoding = "{encoding}"}}\n')) == 1


@pytest.mark.parametrize("encoding", ["latin-9000", "hex", "", "a\\u0000b"])
def test_an_encoding_that_there_is_not_is_refused(encoding: str, bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join(["a,b", *ROWS]))
    with pytest.raises(BadInput, match=r"csv\.encoding = .*; allowed: an encoding of texts, such as utf-8, latin-1"):
        bring(SPEC + f'csv = {{encoding = "{encoding}"}}\n')


@pytest.mark.parametrize(
    ("rows", "layout", "message"),
    [
        (["a,b", *ROWS, "end,0"], "", 'line 52: y = "a": 1 of 51 cells are not finite numbers, the first is "end"'),
        (
            ["a,b", "g,g", *ROWS],
            "",
            'line 2: y = "a": 1 of 51 cells are not finite numbers, the first is "g"'
            "; did you mean csv = {skip_below = 1}?",
        ),
        (
            ["a,b", *ROWS, "", ",0", "inf,0"],
            "",
            'line 53: y = "a": 2 of 52 cells are not finite numbers, the first is ""',
        ),
        (
            ["a;b", *("0,25;1,5" for _ in ROWS)],
            'csv = {delimiter = ";"}',
            'line 2: y = "a": 50 of 50 cells are not finite numbers, the first is "0,25"'
            '; did you mean csv = {decimal = ","}?',
        ),
        (
            [row.replace(",", "\t") for row in ["1,2"] * 50],
            'csv = {header = false}\ny = "1"',
            'line 1: y = "1": 50 of 50 cells are not finite numbers, the first is "1\\t2"'
            '; did you mean csv = {delimiter = "\\t"}?',
        ),
        (
            ["made by X", "a,b", *ROWS],
            'csv = {header = false, skip_lines = 1}\ny = "1"',
            'line 2: y = "1": 1 of 51 cells are not finite numbers, the first is "a"'
            "; did you mean csv = {skip_lines = 2}?",
        ),
    ],
    ids=["footer", "units", "empty", "decimal", "delimiter", "header"],
)
def test_a_cell_that_is_no_number_is_shown_with_its_line(
    rows: list[str], layout: str, message: str, bring: Bring, tmp_path: Path
) -> None:
    (tmp_path / "a.csv").write_text("\n".join(rows))
    spec = SPEC.replace('y = "a"\n', "") if "y = " in layout else SPEC
    with pytest.raises(BadInput) as problem:
        bring(f"{spec}{layout}\n")
    assert str(problem.value) == f"{tmp_path / 'a.csv'}, {message}"


def test_an_odd_line_amid_numbers_is_no_header_that_takes_those_above_with_it(bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join(["1,2"] * 9 + ["1,2,3"] + ["1,2"] * 50))
    with pytest.raises(BadInput, match=r"line 10: 3 cells, but the table has 2 columns; allowed: as many"):
        bring(f"{SPEC}csv = {{header = false}}\n")


def test_a_column_may_have_the_sign_of_alternatives_in_its_name(bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("RPM|1,a\n" + "1500,1.0\n" * 8 + "1500,2.0\n" * 12)
    corpus = bring(f'{SPEC}speed_rpm = {{variable = "RPM|1"}}\n')
    assert corpus.labels["speed_rpm"].tolist() == [1500.0]


def at_once_only(patched: pytest.MonkeyPatch) -> None:
    """From now on no table is split into cells, but for the first rows by which its layout is known."""

    def first_rows(*arguments: Any, most: int) -> list[Row]:
        return read_csv_rows(*arguments, most=most)

    patched.setattr("datagen.formats.csv_file.read_csv_rows", first_rows)


def cell_by_cell_only(patched: pytest.MonkeyPatch) -> None:
    """From now on numpy reads no table at once."""

    def refuses(*_: object, **__: object) -> None:
        raise ValueError("not read at once")

    patched.setattr(np, "loadtxt", refuses)


@pytest.mark.parametrize(
    ("head", "layout"),
    [
        ("a,b\n", CsvLayout()),
        ("\n\nsome words\n\na,b\n\n", CsvLayout(skip_lines=3)),
        ("a;b\r\n", CsvLayout(delimiter=";", decimal=",")),
        ("a\tb\n", CsvLayout(delimiter="\t")),
        ("a  b\n", CsvLayout(delimiter=" ")),
        ("a,b\n\ns,g\n\n", CsvLayout(skip_below=1)),
        ("a,b,\n", CsvLayout()),
    ],
)
def test_a_table_of_nothing_but_numbers_is_read_at_once_and_gives_the_same(
    head: str, layout: CsvLayout, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lines = [layout.delimiter.join(map(repr, cells)).replace(".", layout.decimal) for cells in CELLS]
    (tmp_path / "a.csv").write_text(head + "\n".join(lines), newline="")
    with monkeypatch.context() as patched:
        at_once_only(patched)
        at_once = read_arrays(tmp_path / "a.csv", None, layout)
    with monkeypatch.context() as patched:
        cell_by_cell_only(patched)
        by_cells = read_arrays(tmp_path / "a.csv", None, layout)
    for columns in (at_once, by_cells):
        assert [columns[name].tolist() for name in columns] == np.array(CELLS).T.tolist()
        assert list(columns) == ["a", "b"]


@pytest.mark.parametrize(("end", "decimal"), [("", "."), (",", "."), ("", ",")])
def test_a_table_with_a_clock_is_read_at_once_and_gives_the_same(
    end: str, decimal: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    delimiter = "," if decimal == "." else ";"
    numbers = [[repr(number).replace(".", decimal) for number in cells] for cells in CELLS]
    lines = [delimiter.join([f"12:30:{k:02}", first, "on", second]) + end for k, (first, second) in enumerate(numbers)]
    (tmp_path / "a.csv").write_text("\n".join([delimiter.join(["clock", "a", "state", "b"]), *lines]))
    layout = CsvLayout(delimiter=delimiter, decimal=decimal)
    with monkeypatch.context() as patched:
        at_once_only(patched)
        at_once = read_csv(tmp_path / "a.csv", layout)
    with monkeypatch.context() as patched:
        cell_by_cell_only(patched)
        by_cells = read_csv(tmp_path / "a.csv", layout)
    for columns in (at_once, by_cells):
        assert list(columns) == ["clock", "a", "state", "b"]
        assert np.array([columns["a"], columns["b"]]).T.tolist() == CELLS
        assert np.isnan([columns["clock"], columns["state"]]).all()
        assert columns.odd == {"clock": (2, "12:30:00"), "state": (2, "on")}


@pytest.mark.parametrize(
    ("slow", "end", "is_at_once"),
    [
        ({0: "29.1"}, "", True),
        ({1: "29.1", 30: "30"}, "", True),
        ({2: "29.1"}, ",", True),
        ({0: "29.1", 1: "30"}, "", False),  # nothing in the first two rows shows that cells are empty
        ({0: "inf"}, "", False),
    ],
)
def test_a_table_with_empty_cells_in_its_first_rows_is_read_at_once_and_gives_the_same(
    slow: dict[int, str], end: str, is_at_once: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lines = [f"{first!r},{slow.get(k, '')},{second!r}{end}" for k, (first, second) in enumerate(CELLS)]
    (tmp_path / "a.csv").write_text("\n".join(["a,rpm,b", *lines]))
    with monkeypatch.context() as patched:
        if is_at_once:
            at_once_only(patched)
        at_once = read_csv(tmp_path / "a.csv", CsvLayout())
    with monkeypatch.context() as patched:
        cell_by_cell_only(patched)
        by_cells = read_csv(tmp_path / "a.csv", CsvLayout())
    for columns in (at_once, by_cells):
        assert list(columns) == ["a", "rpm", "b"]
        assert np.array([columns["a"], columns["b"]]).T.tolist() == CELLS
        np.testing.assert_array_equal(columns["rpm"], [float(slow.get(k, "nan")) for k in range(50)])
    assert at_once.odd == by_cells.odd


@pytest.mark.parametrize("later", ["7", "nan"])
def test_a_word_above_numbers_is_shown_as_before(later: str, bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("a,b\ng,1.0\n" + f"{later},1.0\n" * 20)
    hint = "; did you mean csv = {skip_below = 1}?" if later == "7" else ""
    with pytest.raises(BadInput) as problem:
        bring(SPEC)
    count = 1 if later == "7" else 21
    assert str(problem.value).startswith(
        f'{tmp_path / "a.csv"}, line 2: y = "a": {count} of 21 cells are not finite numbers, the first is "g"{hint}'
    )


WHOLE_ROWS = {
    "a semicolon": ("t;acc\n0.5;1.5\n", "", 'csv = {delimiter = ";"}'),
    "a tabulator": ("t\tacc\n0.5\t1.5\n", "", 'csv = {delimiter = "\\t"}'),
    "blanks": ("t acc\n0.5  1.5\n", "", 'csv = {delimiter = " "}'),
    "a comma": ("t,acc\n0.5,1.5\n", 'csv = {delimiter = ";"}\n', 'csv = {delimiter = ","}'),
    "decimal commas": ("t;acc\n0,5;1,5\n", "", 'csv = {delimiter = ";", decimal = ","}'),
    "no header": ("0.5;1.5\n", "csv = {header = false}\n", 'csv = {delimiter = ";"}'),
    "its own name": ("acc\n0.5;1.5\n", "", 'csv = {delimiter = ";"}'),
}


@pytest.mark.parametrize("case", WHOLE_ROWS)
def test_the_delimiter_that_was_meant_is_named(case: str, bring: Bring, tmp_path: Path) -> None:
    text, layout, meant = WHOLE_ROWS[case]
    *head, row = text.splitlines(keepends=True)
    (tmp_path / "a.csv").write_text("".join(head) + 40 * row)
    with pytest.raises(BadInput) as refused:
        bring(SPEC.replace('y = "a"', 'y = "acc"') + layout)
    assert f"; did you mean {meant}?" in str(refused.value)


def test_no_delimiter_is_guessed_where_the_rows_are_read(bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("acc in g; y\n" + 40 * "1.5\n")
    with pytest.raises(BadInput) as refused:
        bring(SPEC.replace('y = "a"', 'y = "acc"'))
    assert "did you mean csv" not in str(refused.value)


@pytest.mark.parametrize(("rows", "line"), [(["1.5"] * 40 + ["End of file"], 42), (["m / s2"] + ["1.5"] * 40, 2)])
def test_no_delimiter_is_guessed_from_a_line_that_is_unlike_the_rest(
    rows: list[str], line: int, bring: Bring, tmp_path: Path
) -> None:
    (tmp_path / "a.csv").write_text("\n".join(["a", *rows]))
    with pytest.raises(BadInput, match=f'line {line}: y = "a": 1 of 41 cells are not finite numbers') as refused:
        bring(SPEC)
    assert "delimiter =" not in str(refused.value)


@pytest.mark.parametrize("way", [at_once_only, cell_by_cell_only])
def test_a_delimiter_at_the_end_of_each_row_makes_an_empty_column(
    way: Callable[[pytest.MonkeyPatch], None], bring: Bring, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    way(monkeypatch)
    rows = "".join(f"{first!r}\t{second!r}\t\r\n" for first, second in CELLS)
    (tmp_path / "a.csv").write_text("by hand\n" + rows, newline="")
    columns = read_arrays(tmp_path / "a.csv", None, CsvLayout(delimiter="\t", header=False, skip_lines=1))
    assert [columns[name].tolist() for name in ("1", "2")] == np.array(CELLS).T.tolist()
    assert np.isnan(columns["3"]).all()
    message = r'a\.csv, line 2: y = "3": 50 of 50 cells are not finite numbers, the first is ""'
    with pytest.raises(BadInput, match=message):
        bring(SPEC.replace('y = "a"', 'y = "3"') + 'csv = {delimiter = "\\t", header = false, skip_lines = 1}\n')


def test_a_last_column_that_is_not_empty_everywhere_is_kept(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("1,2,\n3,4,\n5,6,7\n")
    columns = read_arrays(tmp_path / "a.csv", None, CsvLayout(header=False))
    assert columns["3"][2] == 7.0
    assert columns["2"].tolist() == [2.0, 4.0, 6.0]


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ('rate_hz = {variable = "Zeit", times = true}',
         r'a\.csv, line 4: rate_hz = "Zeit": 2 of 50 cells are not finite numbers, the first is "0,002"'),
        ('rate_hz = 1000\nload_n = {variable = "Zeit[3]"}', r'a\.csv: load_n = "Zeit\[3\]": is not a finite number'),
    ],
)  # fmt: skip
def test_a_number_that_a_table_does_not_hold_is_told_with_line_and_cell(
    setting: str, message: str, bring: Bring, tmp_path: Path
) -> None:
    times = [str(k / 1000.0) for k in range(50)]
    times[2], times[3] = '"0,002"', "?"
    rows = [f"{first!r},{time}" for (first, _), time in zip(CELLS, times, strict=True)]
    (tmp_path / "a.csv").write_text("\n".join(["a,Zeit", *rows]))
    with pytest.raises(BadInput, match=message):
        bring(SPEC.replace("rate_hz = 1000", setting))


DECIMAL_COMMAS = {
    "semicolons": ("0,25;-1,5", "", '{delimiter = ";", decimal = ","}'),
    "whole numbers too": ("7;-1,5;3", "", '{delimiter = ";", decimal = ","}'),
    "tabulators": ("0,25\t1,5e-3", "", '{delimiter = "\\t", decimal = ","}'),
    "blanks": ("0,25  1,5", "", '{delimiter = " ", decimal = ","}'),
    "a header with as many commas": ("0,25;1,5", "time, s;acc, g", '{delimiter = ";", decimal = ","}'),
}


@pytest.mark.parametrize("case", DECIMAL_COMMAS)
def test_a_table_is_refused_whose_decimal_commas_part_it(case: str, bring: Bring, tmp_path: Path) -> None:
    row, header, meant = DECIMAL_COMMAS[case]
    (tmp_path / "a.csv").write_text("\n".join([header] * bool(header) + [row] * 50))
    name = "time" if header else "1"
    spec = SPEC.replace('y = "a"', f'y = "{name}"') + f"csv = {{header = {str(bool(header)).lower()}}}\n"
    with pytest.raises(BadInput) as refused:
        bring(spec)
    line = 2 if header else 1
    assert str(refused.value) == (
        f'{tmp_path / "a.csv"}, line {line}: csv.delimiter = ",": these commas seem to be decimal signs'
        f"; did you mean csv = {meant}?"
    )


@pytest.mark.parametrize("row", ["10 30,5", "0.5, 1.5", "a;b,1.5", "2,3"])
def test_a_table_whose_commas_part_cells_is_read(row: str, bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join([row] * 50))
    spec = SPEC.replace('y = "a"', 'y = "2"') + "csv = {header = false}\n"
    assert bring(spec).waveform(0, "acceleration")[0, 0] == pytest.approx(9.80665 * float(row.split(",")[1]))


def test_a_header_of_numbers_is_taken_for_the_first_row(bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join(ROWS))
    with pytest.raises(
        BadInput, match=r'y = "1": the file has no such variable; did you mean csv = \{header = false\}'
    ):
        bring(SPEC.replace('y = "a"', 'y = "1"'))


COMMENTED = {
    "one": (["# made by X", "a,b"], "", "{skip_lines = 1}"),
    "two, and a blank line": (["% made by X", "", "% 1000 Hz, 2 axes, g", "a,b"], "", "{skip_lines = 3}"),
    "above rows without names": (["; made by X", "; 1000 Hz"], "", "{header = false, skip_lines = 2}"),
    "above rows that are said to have no names": (["# made by X"], "header = false", "{skip_lines = 1}"),
    "as many cells": (["# made by X,2024", "# rate,high"], "header = false", "{skip_lines = 2}"),
}


@pytest.mark.parametrize("case", COMMENTED)
def test_comments_above_a_table_come_with_their_number(case: str, bring: Bring, tmp_path: Path) -> None:
    above, layout, meant = COMMENTED[case]
    (tmp_path / "a.csv").write_text("\n".join([*above, *ROWS]))
    named = SPEC if above[-1] == "a,b" else SPEC.replace('y = "a"', 'y = "1"')
    message = refusal(bring, named + f"csv = {{{layout}}}\n", tmp_path)
    assert f"; did you mean csv = {meant}?" in message
    both = ", ".join(filter(None, [layout, meant.strip("{}")]))
    assert len(bring(named + f"csv = {{{both}}}\n")) == 1


def test_lines_above_the_header_come_with_a_way_out(bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join(["date 2024", "a,b", *ROWS]))
    with pytest.raises(
        BadInput, match=r"line 2: 2 cells, but the table has 1 columns; did you .*; allowed: .*csv\.skip_lines"
    ):
        bring(SPEC)
    assert len(bring(SPEC + "csv = {skip_lines = 1}\n")) == 1


@pytest.mark.parametrize("title", ["Date\t2024", "Made in Ulm, Germany\t1", "x"])
def test_lines_of_titles_above_numbers_of_another_delimiter_come_with_the_layout(
    title: str, bring: Bring, tmp_path: Path
) -> None:
    numbers = "\n".join(f"{first!r}\t{second!r}\t1" for first, second in CELLS)
    (tmp_path / "a.csv").write_text(f"Header\n{title}\n\nrate\t0.001\nData\n{numbers}\n")
    said = 'csv = {header = false, skip_lines = 5, delimiter = "\\t"}'
    with pytest.raises(BadInput, match=re.escape(f"did you mean {said}?")):
        bring(SPEC)
    assert bring(SPEC.replace('y = "a"', 'y = "1"') + said).signal(0, "y").size == len(CELLS)


def test_decimal_commas_below_titles_are_not_taken_for_a_delimiter(bring: Bring, tmp_path: Path) -> None:
    numbers = "\n".join(repr(first).replace(".", ",") for first, _ in CELLS)
    (tmp_path / "a.csv").write_text(f"Header\nx\n{numbers}\n")
    with pytest.raises(BadInput) as caught:
        bring(SPEC.replace('y = "a"', 'y = "Header"') + 'csv = {delimiter = ";", decimal = ","}\n')
    assert "delimiter" not in str(caught.value)


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1"])
@pytest.mark.parametrize("workbook", [False, True])
def test_a_packed_table_is_called_so(workbook: bool, encoding: str, bring: Bring, tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "a.csv", "w") as file:
        file.writestr("a.csv", "\n".join(["a,b", *ROWS]))
    if workbook:
        (tmp_path / "a.csv").write_bytes(bytes.fromhex("d0cf11e0a1b11ae1") + bytes(504))
    with pytest.raises(BadInput, match=r"a\.csv: is packed or a workbook, not text; allowed: the table as text"):
        bring(SPEC + f'csv = {{encoding = "{encoding}"}}\n')


@pytest.mark.parametrize("hole", [False, True])
@pytest.mark.parametrize("name", ["a.csv", "a.csv.gz", "a.TXT.GZ"])
def test_a_table_that_gzip_compressed_is_read_as_it_is(name: str, hole: bool, bring: Bring, tmp_path: Path) -> None:
    rows = [*ROWS, ROWS[0].replace(",", ",x")] if hole else ROWS  # a text in the other column: not a clean table
    text = "\n".join(["a,b", *rows])
    (tmp_path / "plain.csv").write_text(text)
    (tmp_path / name).write_bytes(gzip.compress(text.encode()))
    plain = bring(SPEC.replace("a.csv", "plain.csv"), "plain")
    packed = bring(SPEC.replace("a.csv", name), "packed")
    assert packed.labels["recording"].tolist() == ["a"]
    assert np.array_equal(packed.signal(0, "y"), plain.signal(0, "y"))


@pytest.mark.parametrize("damage", ["cut off", "changed"])
def test_a_compressed_table_that_is_damaged_is_refused(damage: str, bring: Bring, tmp_path: Path) -> None:
    whole = gzip.compress("\n".join(["a,b", *ROWS]).encode())
    spoilt = whole[:-20] if damage == "cut off" else whole[:-8] + bytes([whole[-8] ^ 1]) + whole[-7:]
    (tmp_path / "a.csv").write_bytes(spoilt)
    with pytest.raises(BadInput, match=r"a\.csv: cannot be read: its compressed text is damaged or breaks off"):
        bring(SPEC)


@pytest.mark.parametrize("width", [1, 2])
def test_a_table_of_nothing_but_decimal_commas_is_not_read_as_whole_numbers(
    width: int, bring: Bring, tmp_path: Path
) -> None:
    rows = np.random.default_rng(3).uniform(-2.0, 2.0, (200, width))
    text = "\n".join(",".join(f"{value:.5f}".replace(".", ",") for value in row) for row in rows)
    (tmp_path / "a.csv").write_text(text)
    spec = '[[recording]]\nname = "all"\nfiles = "a.csv"\nunit = "m/s2"\nrate_hz = 1000\ny = "1"\n'
    message = refusal(bring, spec + "csv = {header = false}\n", tmp_path)
    assert 'line 1: csv.delimiter = ",": these commas seem to be decimal signs; ' in message
    if width == 1:
        assert message.endswith('did you mean csv = {delimiter = ";", decimal = ","}?')
        corpus = bring(spec + 'csv = {header = false, delimiter = ";", decimal = ","}\n', "second")
        assert corpus.waveform(0, "acceleration")[:, 0] == pytest.approx(rows[:, 0], abs=6e-6)


@pytest.mark.parametrize("row", ["12,345", "0,10", "-3,7", "7,0"])
def test_whole_numbers_in_two_columns_stay_what_they_are(row: str, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(f"{row}\n5,20\n" * 20)
    found = read_arrays(tmp_path / "a.csv", None, CsvLayout(header=False))
    assert [found["1"][0], found["2"][0]] == [float(cell) for cell in row.split(",")]


@pytest.mark.parametrize(
    ("layout", "hint"),
    [("", '{delimiter = ";", decimal = ","}'), ('csv = {delimiter = ";"}\n', '{decimal = ","}')],
)
def test_one_column_of_decimal_commas_below_a_name_is_led_to_the_layout_that_reads_it(
    layout: str, hint: str, bring: Bring, tmp_path: Path
) -> None:
    (tmp_path / "a.csv").write_text("acc\n" + "0,02314\n-0,5\n" * 20)
    spec = '[[recording]]\nname = "all"\nfiles = "a.csv"\nunit = "g"\nrate_hz = 1000\ny = "acc"\n'
    assert refusal(bring, spec + layout, tmp_path).endswith(f"; did you mean csv = {hint}?")


@pytest.mark.parametrize(
    ("cell", "layout"),
    [
        ('"-1,079.20"', ""),
        ('"1,234,567.5"', ""),
        ("1 079.20", ""),
        ("1.079,20", 'csv = {delimiter = ";", decimal = ","}'),
    ],
)
@pytest.mark.parametrize("place", [0, 20])
def test_signs_between_thousands_are_named(cell: str, layout: str, place: int, bring: Bring, tmp_path: Path) -> None:
    rows = ["a", *["7"] * 40]
    rows[1 + place] = cell
    (tmp_path / "a.csv").write_text("\n".join(rows))
    message = refusal(bring, SPEC + layout + "\n", tmp_path)
    assert f'line {2 + place}: y = "a": 1 of 40 cells are not finite numbers, the first is' in message
    assert "; numbers are read without signs between thousands only" in message
    assert "did you mean" not in message


def test_signs_between_thousands_are_named_beside_columns_of_numbers(bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("a\tb\n" + "1.234,5\t1\n" * 40)
    message = refusal(bring, SPEC + 'csv = {delimiter = "\\t", decimal = ","}\n', tmp_path)
    assert 'the first is "1.234,5"; numbers are read without signs between thousands only' in message


@pytest.mark.parametrize("cell", ["0,079.20", '"12,34.5"', "1.079.20", "2,079"])
def test_other_numbers_are_not_called_ones_of_thousands(cell: str, bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join(["a", *["7"] * 20, cell, *["7"] * 20]))
    assert "thousands" not in refusal(bring, SPEC, tmp_path)


@pytest.mark.parametrize("encoding", ["utf-8", "UTF-8", "utf8", "U8"])
def test_a_byte_order_mark_is_no_matter_however_the_encoding_is_spelt(encoding: str, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("acc\n" + "1.5\n" * 20, encoding="utf-8-sig")
    assert list(read_arrays(tmp_path / "a.csv", None, CsvLayout(encoding=encoding))) == ["acc"]


def test_of_a_long_cell_that_is_no_number_forty_signs_are_shown(bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("\n".join(["a,b", *["1,2"] * 50, f"{'x' * 60},2"]))
    with pytest.raises(BadInput, match=rf'the first is "{"x" * 40}"'):
        bring('[[recording]]\nname = "all"\nfiles = "a.csv"\nunit = "g"\nrate_hz = 1000\ny = "a"\n')

"""Measured spalls from files."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from pydantic import ValidationError

from datagen.recipes.profile_table import FOLDER, ProfileTable

HEAD = "angle_deg,depth_um\n"


def read(folder: Path, text: str) -> ProfileTable:
    """The table of a file with this text."""
    (folder / "pit.csv").write_text(text)
    return ProfileTable.model_validate("pit.csv", context={FOLDER: folder})


def test_a_table_is_centred_and_converted_to_si(tmp_path: Path) -> None:
    table = read(tmp_path, HEAD + "10,0\n11,20\n\n14,5\n")
    assert table.extent_deg == 4.0
    assert table.centred_angles() == pytest.approx([math.radians(a) for a in (-2, -1, 2)], rel=1e-15)  # one rounding
    assert table.depths() == (0.0, 2e-5, 5e-6)
    assert table.name == "pit.csv"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the first line must be angle_deg,depth_um"),
        ("depth_um,angle_deg\n1,2\n2,3\n", "the first line must be angle_deg,depth_um"),
        (HEAD + "1,2\n", "at least two"),
        (HEAD + "1,2\n2,deep\n", "line 3: 2,deep is not two finite numbers"),
        (HEAD + "1,2\n2\n", "line 3: 2 is not two finite numbers"),
        (HEAD + '1,2\n\n2,"3\n3,4\n', "pit.csv, line 4: not a row of a CSV table: unexpected end of data"),
        ("\n" + HEAD + "1,2\n\n2,deep\n", "line 5: 2,deep is not two finite numbers"),
        (HEAD + "1,2\n1,3\n", "must rise"),
        (HEAD + "1,0\n2,0\n", "0 throughout"),
        (HEAD + "1,2\n2,-3\n", r"pit\.csv, line 3: depth_um = -3; allowed: 0 to 10000"),
        (HEAD + "1,2\n\n2,20000\n", r"pit\.csv, line 4: depth_um = 20000; allowed: 0 to 10000"),
        (HEAD + "1,2\n2,nan\n", "line 3: 2,nan is not two finite numbers"),
        (HEAD + "1,2\n1_0,3\n", "line 3: 1_0,3 is not two finite numbers"),
        (HEAD + "0,2\n200,2\n", "at most 180"),
    ],
)
def test_a_bad_table_is_refused_with_its_line_or_rule(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(ValidationError, match=message):
        read(tmp_path, text)


def test_a_byte_order_mark_in_a_table_is_no_matter(tmp_path: Path) -> None:
    assert read(tmp_path, "\ufeff" + HEAD + "1,2\n2,3\n").depths() == (2e-6, 3e-6)


def test_a_table_that_is_no_text_is_refused_by_its_path(tmp_path: Path) -> None:
    (tmp_path / "pit.csv").write_bytes(b"angle_deg,depth_um\n1,\xb5\n")
    with pytest.raises(ValidationError, match=r"pit\.csv: not a text file"):
        ProfileTable.model_validate("pit.csv", context={FOLDER: tmp_path})


def test_a_missing_table_is_refused_by_its_path(tmp_path: Path) -> None:
    with pytest.raises(ValidationError, match=r"none\.csv cannot be read"):
        ProfileTable.model_validate("none.csv", context={FOLDER: tmp_path})


@pytest.mark.parametrize("given", [5, True, ["pit.csv"]])
def test_what_names_no_file_is_refused_with_what_would(given: object) -> None:
    with pytest.raises(ValidationError) as caught:
        ProfileTable.model_validate(given)
    context = caught.value.errors()[0]["ctx"]
    assert context["allowed"] == "the name of a CSV file with the columns angle_deg and depth_um"

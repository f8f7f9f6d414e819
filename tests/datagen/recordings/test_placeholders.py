"""Sets whose files are told apart by their folders, or by the time in their names."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from imports import Bring

from datagen.errors import BadInput
from datagen.formats.placeholders import filled, without_ending

FOLDERS = ("35Hz/Bearing1_1", "35Hz/Bearing1_2", "40Hz/Bearing3_1")
SPEC = '[[recording]]\nname = "all"\nfiles = "*/*/*.csv"\nunit = "g"\nrate_hz = 25600\ny = "V"\n'


@pytest.fixture
def numbered(tmp_path: Path) -> None:
    """Three folders, one a bearing, with files called 1.csv and 2.csv in each."""
    for seed, folder in enumerate(FOLDERS):
        (tmp_path / folder).mkdir(parents=True)
        for number in (1, 2):
            samples = np.random.default_rng(10 * seed + number).standard_normal(40)
            (tmp_path / folder / f"{number}.csv").write_text("H,V\n" + "".join(f"0,{one}\n" for one in samples))


@pytest.mark.usefixtures("numbered")
def test_records_and_bearings_may_be_named_after_folders(bring: Bring) -> None:
    corpus = bring(f'{SPEC}recording = "{{path}}"\nbearing_id = "{{folder}}"\nrig = "rig {{number}}"\n')
    assert corpus.labels["recording"].tolist() == [f"{folder}/{number}" for folder in FOLDERS for number in (1, 2)]
    assert corpus.labels["bearing_id"].unique().tolist() == ["Bearing1_1", "Bearing1_2", "Bearing3_1"]
    assert corpus.labels["rig"].unique().tolist() == ["rig 1", "rig 2"]


@pytest.mark.usefixtures("numbered")
def test_a_name_with_its_channel_is_one_for_each_channel(bring: Bring) -> None:
    channels = 'channel = [{name = "V", y = "V"}, {x = "V"}]\n'
    corpus = bring(
        'same_samples = "keep"\n' + SPEC.replace('y = "V"\n', channels) + 'recording = "{folder}:{stem} {channel}"\n'
    )
    assert corpus.labels["recording"].tolist()[:4] == [
        "Bearing1_1:1 V",
        "Bearing1_1:1",
        "Bearing1_1:2 V",
        "Bearing1_1:2",
    ]


@pytest.mark.usefixtures("numbered")
def test_a_name_that_is_taken_comes_with_a_way_out(bring: Bring) -> None:
    with pytest.raises(
        BadInput, match=r'recording = "1": this name is already taken by .*1\.csv .*recording = "\{path\} '
    ):
        bring(SPEC)


@pytest.mark.parametrize("wish", ["{stem:1000}", "{stem:{number}}"])
def test_a_width_without_bounds_is_refused(wish: str) -> None:
    with pytest.raises(BadInput, match="a width in braces"):
        filled(wish, Path("99999999999.csv"), "recording")


def test_figures_alone_are_no_ending(bring: Bring, tmp_path: Path) -> None:
    for second in ("24", "54"):
        samples = np.random.default_rng(int(second)).standard_normal(40)
        (tmp_path / f"2003.10.22.12.06.{second}").write_text("".join(f"0\t{one}\n" for one in samples))
    corpus = bring(
        '[[recording]]\nname = "all"\nfiles = "2003*"\nformat = "csv"\nunit = "g"\nrate_hz = 20480\ny = "2"\n'
        'csv = {delimiter = "\\t", header = false}\n'
    )
    assert corpus.labels["recording"].tolist() == ["2003.10.22.12.06.24", "2003.10.22.12.06.54"]


def test_the_number_of_a_file_is_the_first_in_its_name() -> None:
    assert filled("{number:03}", Path("run7/b12_load3.mat"), "y") == "012"


def test_a_number_too_large_for_a_letter_is_refused() -> None:
    with pytest.raises(BadInput, match="cannot be filled in for this file"):
        filled("{number:c}", Path("a99999999999.npz"), "y")


@pytest.mark.parametrize("text", ["{stem.real_name}", "{stem[a]}", "{what}", "{1}", "{", "{stem:d}"])
def test_braces_that_mean_nothing_are_refused_with_those_that_do(text: str) -> None:
    with pytest.raises(BadInput) as problem:
        filled(text, Path("a/b.mat"), "y")
    assert "cannot be filled in for this file; allowed: {stem}, {number}, {folder}, as in X" in str(problem.value)
    with pytest.raises(BadInput, match="for this file, whose name contains no number"):
        filled("X{number:d}", Path("a/b.mat"), "y")


@pytest.mark.parametrize(("name", "number"), [("run.h5", ""), ("run7.h5", "7"), ("run.nc4", ""), ("a12b3.csv", "12")])
def test_figures_of_an_ending_are_not_the_number_of_a_file(name: str, number: str) -> None:
    assert filled("{number}", Path("35Hz") / name, "rig") == number


@pytest.mark.parametrize("name", ["a.csv", "a.csv.gz", "a.CSV.GZ", "a.mat"])
def test_a_name_without_its_ending_has_none_of_packed_tables_either(name: str) -> None:
    assert without_ending(Path(name)) == "a"

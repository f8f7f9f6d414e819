from __future__ import annotations

import struct
import wave
from collections.abc import Callable
from pathlib import Path

import h5py
import netCDF4
import numpy as np
import pytest
import scipy.io

from datagen.errors import BadInput
from datagen.formats.arrays import NoVariable, as_numbers, choose, chosen
from datagen.formats.csv_file import read_csv
from datagen.formats.csv_layout import CsvLayout
from datagen.formats.reading import file_format, read_arrays

PLAIN = CsvLayout()


def test_variables_and_fields_of_structures_of_a_mat_file_come_by_name(tmp_path: Path) -> None:
    column = np.arange(20.0)[:, None]
    scipy.io.savemat(tmp_path / "a.mat", {"top": column, "bearing": {"gs": column * 2.0, "sr": 97656.0}, "text": "no"})
    arrays = read_arrays(tmp_path / "a.mat", None, PLAIN)
    assert set(arrays) == {"top", "bearing.gs", "bearing.sr"}
    assert np.array_equal(choose(arrays, "bearing.gs", tmp_path / "a.mat", "y"), np.arange(20.0) * 2.0)


def test_a_mat_file_of_version_7_3_is_read_with_its_dimensions_in_matlabs_order(tmp_path: Path) -> None:
    with netCDF4.Dataset(tmp_path / "a.h5", "w") as file:
        file.createDimension("columns", 2)
        file.createDimension("rows", 30)
        file.createVariable("both", "f8", ("columns", "rows"))[...] = np.arange(60.0).reshape(2, 30)
        group = file.createGroup("bearing")
        group.createVariable("gs", "f8", ("columns", "rows"))[...] = np.arange(60.0).reshape(2, 30) + 0.5
    header = b"MATLAB 7.3 MAT-file".ljust(512, b"\0")
    (tmp_path / "a.mat").write_bytes(header + (tmp_path / "a.h5").read_bytes())
    arrays = read_arrays(tmp_path / "a.mat", None, PLAIN)
    assert np.array_equal(choose(arrays, "both[:,1]", tmp_path / "a.mat", "y"), np.arange(30.0, 60.0))
    assert arrays["bearing.gs"].shape == (30, 2)


def test_members_of_npz_and_the_array_of_npy_are_read_without_pickles(tmp_path: Path) -> None:
    counts = np.arange(-5, 25, dtype=np.int16)
    np.savez(tmp_path / "a.npz", **{"97_DE": counts, "2003.10.22": np.stack([counts, counts + 1], axis=1)})
    arrays = read_arrays(tmp_path / "a.npz", None, PLAIN)
    assert choose(arrays, "97_DE", tmp_path, "y").dtype == np.int16
    assert np.array_equal(choose(arrays, "2003.10.22[:,1]", tmp_path, "y"), counts + 1)
    np.save(tmp_path / "b.npy", counts)
    assert np.array_equal(read_arrays(tmp_path / "b.npy", None, PLAIN)["data"], counts)
    np.save(tmp_path / "c.npy", np.array([{}], dtype=object), allow_pickle=True)
    with pytest.raises(BadInput, match=r"c\.npy: it holds Python objects, which are not read"):
        read_arrays(tmp_path / "c.npy", None, PLAIN)


@pytest.mark.parametrize(
    ("text", "layout", "name"),
    [
        ("t,acc [g]\n0,1.5\n1,-2\n", PLAIN, "acc [g]"),
        ("made by hand\nt;a\n0;1,5\n1;-2\n", CsvLayout(delimiter=";", decimal=",", skip_lines=1), "a"),
        ("0.0   1.5\n1.0  -2\n", CsvLayout(delimiter=" ", header=False), "2"),
        ("0\t1.5\n1\t-2\n", CsvLayout(delimiter="\t", header=False), "2"),
    ],
)
def test_columns_of_text_tables_are_read_however_they_are_laid_out(
    text: str, layout: CsvLayout, name: str, tmp_path: Path
) -> None:
    (tmp_path / "a.csv").write_text(text)
    assert read_arrays(tmp_path / "a.csv", None, layout)[name].tolist() == [1.5, -2.0]


@pytest.mark.parametrize(
    ("text", "layout", "message"),
    [
        ("a,b\n\n1,2\n\n3\n", PLAIN, "line 5: 1 cells, but the table has 2 columns"),
        ("by hand\n\n1,2\n3\n", CsvLayout(header=False, skip_lines=1), "line 4: 1 cells"),
        ("0 1\n\n  \n2\n", CsvLayout(header=False, delimiter=" "), "line 4: 1 cells"),
        ("\na,a\n1,2\n", PLAIN, "line 2: a: this column occurs twice"),
        ('a,b\n1,2\n3,"4\n5,6\n7,8\n', PLAIN, "line 3: not a row of a CSV table: unexpected end of data"),
        ("a,b\n1," + "2" * 200_000 + "\n", PLAIN, "line 2: not a row of a CSV table: field larger than field limit"),
    ],
    ids=["blank", "skipped", "blanks", "head", "unclosed quote", "endless cell"],
)
def test_a_line_of_a_text_table_that_is_wrong_is_named_by_its_number_in_the_file(
    text: str, layout: CsvLayout, message: str, tmp_path: Path
) -> None:
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(BadInput) as problem:
        read_arrays(tmp_path / "a.csv", None, layout)
    assert str(problem.value).startswith(f"{tmp_path / 'a.csv'}, {message}")


def test_a_file_without_an_ending_is_read_by_the_stated_format(tmp_path: Path) -> None:
    (tmp_path / "2003.10.22.12.14.13").write_text("1\t2\n3\t4\n")
    layout = CsvLayout(delimiter="\t", header=False)
    assert read_arrays(tmp_path / "2003.10.22.12.14.13", "csv", layout)["1"].tolist() == [1.0, 3.0]
    with pytest.raises(
        BadInput, match=r'format = "13": the file.s name does not end like that of a known format; allowed: mat, npz'
    ):
        read_arrays(tmp_path / "2003.10.22.12.14.13", None, layout)


def test_whole_numbers_of_a_wave_file_become_shares_of_full_scale(tmp_path: Path) -> None:
    with wave.open(str(tmp_path / "a.wav"), "wb") as file:
        file.setnchannels(2)
        file.setsampwidth(2)
        file.setframerate(8000)
        file.writeframes(struct.pack("<6h", 0, 1, -32768, 2, 16384, 3))
    arrays = read_arrays(tmp_path / "a.wav", None, PLAIN)
    assert choose(arrays, "data[:,0]", tmp_path, "y").tolist() == [0.0, -1.0, 0.5]
    assert arrays["rate_hz"] == 8000.0
    with wave.open(str(tmp_path / "b.wav"), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(1)
        file.setframerate(8000)
        file.writeframes(bytes([128, 0, 192]))
    assert read_arrays(tmp_path / "b.wav", None, PLAIN)["data"].tolist() == [0.0, -1.0, 0.5]


def test_a_netcdf_variable_is_scaled_by_its_own_attributes(tmp_path: Path) -> None:
    with netCDF4.Dataset(tmp_path / "a.nc", "w") as file:
        file.createDimension("time", 4)
        packed = file.createVariable("acc", "i2", ("time",), fill_value=-9)
        packed.scale_factor = 0.5
        packed.set_auto_maskandscale(False)
        packed[...] = np.array([2, 4, -6, -9], dtype=np.int16)
    values = read_arrays(tmp_path / "a.nc", None, PLAIN)["acc"]
    assert values[:3].tolist() == [1.0, 2.0, -3.0]
    assert np.isnan(values[3])


@pytest.mark.parametrize("ending", ["mat", "npz", "npy", "wav", "nc"])
def test_a_file_of_other_bytes_than_its_ending_says_is_refused_with_its_name(ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"a.{ending}"
    path.write_bytes(b"this is not it, whatever it is " * 40)
    with pytest.raises(BadInput, match=rf"a\.{ending}: cannot be read as an? .*file"):
        read_arrays(path, None, PLAIN)


def test_a_wave_file_of_compressed_sound_is_refused(tmp_path: Path) -> None:
    body = struct.pack("<4sIHHIIHH", b"fmt ", 16, 7, 1, 8000, 8000, 1, 8) + struct.pack("<4sI", b"data", 4) + b"abcd"
    (tmp_path / "a.wav").write_bytes(struct.pack("<4sI4s", b"RIFF", 4 + len(body), b"WAVE") + body)
    with pytest.raises(BadInput, match=r"a\.wav: cannot be read as a wave file: .*MULAW.*; allowed: linear PCM"):
        read_arrays(tmp_path / "a.wav", None, PLAIN)


def test_the_name_of_a_variable_may_hold_the_files_number_and_alternatives() -> None:
    arrays = {"X098_DE_time": np.zeros(3), "X099_DE_time": np.ones(3)}
    assert chosen(arrays, "X{number:03}_DE_time|X*_DE_time", Path("99.mat"), "y")[0] == "X099_DE_time"
    only = {"X173_DE_time": np.zeros(3)}
    assert chosen(only, "X{number:03}_DE_time|X*_DE_time", Path("174_0.mat"), "y")[0] == "X173_DE_time"
    with pytest.raises(BadInput, match="fits 2 variables: X098_DE_time, X099_DE_time"):
        chosen(arrays, "X*_DE_time", Path("99.mat"), "y")


def test_an_absent_variable_is_refused_with_the_names_that_are_there() -> None:
    with pytest.raises(
        NoVariable, match=r'99\.mat: y = "X099_FE": .*did you mean "X099_DE"\?; allowed: X099RPM, X099_DE'
    ):
        chosen({"X099_DE": np.zeros(3), "X099RPM": np.zeros(1)}, "X{number:03}_FE", Path("99.mat"), "y")
    with pytest.raises(
        BadInput, match=r'y = "a\[:,3\]": a is an array of 4x2 numbers; allowed: a, a\[0,:\] to a\[3,:\], a\[:,0\]'
    ):
        choose({"a": np.zeros((4, 2))}, "a[:,3]", Path("a.npy"), "y")


def test_elements_of_an_array_of_structures_are_not_guessed_at_by_their_texts() -> None:
    channels = {f"run.Y[{place}].Data": np.zeros(3) for place in range(7)} | {"run.X[0].Data": np.zeros(3)}
    message = (
        r"no such variable; its elements are counted from 0: run\.Y\[0\]\.Data, run\.Y\[1\].*run\.Y\[6\]\.Data; all"
    )
    with pytest.raises(NoVariable, match=message) as refused:
        chosen(channels, "run.Y.vibration_1.Data", Path("run.mat"), "y")
    assert "did you mean" not in str(refused.value)


def write_7_3(path: Path) -> None:
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, text in (("fs", "12000"), ("who", "me")):
            letters = np.array([[ord(letter)] for letter in text], dtype="u2")
            file.create_dataset(name, data=letters).attrs["MATLAB_class"] = np.bytes_("char")
    path.write_bytes(b"MATLAB 7.3 MAT-file".ljust(512, b"\0") + path.read_bytes()[512:])


def write_attributes(path: Path) -> None:
    with h5py.File(path, "w") as file:
        file.attrs["fs"] = "12000"
        file.attrs["who"] = "me"


@pytest.mark.parametrize(
    ("name", "write", "mark"),
    [
        ("a.mat", lambda path: scipy.io.savemat(path, {"fs": "12000", "who": "me"}), ""),
        ("b.mat", write_7_3, ""),
        ("a.npz", lambda path: np.savez(path, fs=np.array("12000"), who=np.array("me")), ""),
        ("a.h5", write_attributes, "@"),
    ],
)
def test_a_number_that_is_written_as_a_text_is_one(
    name: str, write: Callable[[Path], None], mark: str, tmp_path: Path
) -> None:
    path = tmp_path / name
    write(path)
    arrays = read_arrays(path, None, PLAIN)
    assert choose(arrays, f"{mark}fs", path, "rate_hz").tolist() == 12000.0
    if name != "a.npz":  # whose arrays are not looked at before they are asked for
        with pytest.raises(NoVariable):
            choose(arrays, f"{mark}who", path, "rate_hz")


def test_a_date_beside_a_signal_fits_no_pattern(tmp_path: Path) -> None:
    path = tmp_path / "a.mat"
    scipy.io.savemat(path, {"X097_DE_time": np.arange(9.0), "start_time": "20240101"})
    arrays = read_arrays(path, None, PLAIN)
    assert choose(arrays, "*_time", path, "y").tolist() == list(range(9))
    assert choose(arrays, "start_time", path, "y").tolist() == 20240101.0


def test_an_array_of_numbers_that_are_written_as_texts_is_one_of_numbers(tmp_path: Path) -> None:
    path = tmp_path / "a.npy"
    np.save(path, np.array(["1.5", "2"]))
    assert choose(read_arrays(path, None, PLAIN), "data", path, "y").tolist() == [1.5, 2.0]
    np.save(path, np.array(["1.5", "x"]))
    with pytest.raises(NoVariable, match="the file holds no numbers"):
        choose(read_arrays(path, None, PLAIN), "data", path, "y")


def test_the_fields_of_a_structured_array_come_by_name(tmp_path: Path) -> None:
    table = np.zeros(20, dtype=[("time", "f8"), ("acc", "f4", (3,)), ("note", "U4")])
    table["time"], table["acc"], table["note"] = np.arange(20.0), np.arange(60.0).reshape(20, 3), "good"
    np.save(tmp_path / "a.npy", table)
    arrays = read_arrays(tmp_path / "a.npy", None, PLAIN)
    assert choose(arrays, "data.time", tmp_path / "a.npy", "y").tolist() == list(range(20))
    assert choose(arrays, "data.acc[:,1]", tmp_path / "a.npy", "y").tolist() == list(range(1, 60, 3))
    with pytest.raises(NoVariable, match=r"data\.note\": is a text, .*; allowed: the number itself, or data\.acc"):
        choose(arrays, "data.note", tmp_path / "a.npy", "y")


def test_a_name_or_a_date_is_no_number_though_python_reads_one(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("day,run,a\n2024_05_17,1_5,1.5\n2024_05_18,2,-2\n")
    table = read_arrays(tmp_path / "a.csv", None, PLAIN)
    assert np.isnan(table["day"]).all()
    assert table["run"].tolist()[1] == 2.0
    assert np.isnan(table["run"][0])
    assert table["a"].tolist() == [1.5, -2.0]


@pytest.mark.parametrize("rows", ["1,,3\n2,105_2,4\n", "1,2,3\n2,,4\n3,105_2,5\n"])
def test_a_name_below_a_gap_is_no_number_either(rows: str, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(f"a,b,c\n{rows}")
    assert np.isnan(read_arrays(tmp_path / "a.csv", None, PLAIN)["b"][-1])


def test_the_arrays_of_a_file_are_read_when_they_are_asked_for_and_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    np.savez(tmp_path / "a.npz", a=np.arange(3.0), b=np.arange(4.0))
    opened = []
    load = np.load
    monkeypatch.setattr(np, "load", lambda path: opened.append(path) or load(path))
    arrays = read_arrays(tmp_path / "a.npz", None, PLAIN)
    assert "a" in arrays
    assert "c" not in arrays
    assert list(arrays) == ["a", "b"]
    chosen = [choose(arrays, "b", tmp_path / "a.npz", "y") for _ in range(3)]
    assert chosen[0].tolist() == [0.0, 1.0, 2.0, 3.0]
    assert chosen[0] is chosen[1] is chosen[2]
    assert len(opened) == 1


@pytest.mark.parametrize("texts", [["nan"], ["12.5", "inf"], ["12.5", "fast"], ["105_2"], []])
def test_texts_of_which_one_is_no_finite_number_stay_texts(texts: list[str]) -> None:
    told = np.array(texts, dtype=np.str_)
    assert as_numbers(told) is told
    assert as_numbers(np.array([" 12.5", "-3e2"])).tolist() == [12.5, -300.0]


def test_places_are_counted_from_the_end_too() -> None:
    arrays = {"table": np.arange(12.0).reshape(3, 4)}
    assert choose(arrays, "table[:,-1]", Path("a.npy"), "y").tolist() == [3.0, 7.0, 11.0]
    assert choose(arrays, "table[-1,0]", Path("a.npy"), "y") == 8.0


def test_brackets_of_a_pattern_mean_themselves() -> None:
    arrays = {"S[2].F": np.zeros(3), "S2.F": np.ones(3), "S[1].F": np.ones(3)}
    assert chosen(arrays, "S[2].*", Path("a.mat"), "y") == ("S[2].F", None)
    assert chosen(arrays, "S[2].?[0]", Path("a.mat"), "y") == ("S[2].F", "0")


def test_names_alike_are_those_in_other_capitals_before_those_that_hold_the_wish() -> None:
    arrays = {"ACC": np.zeros(3), "acc_y": np.zeros(3), "a": np.zeros(3)}
    for wish, hint in (("Acc", '; did you mean "ACC"?'), ("c", "")):
        with pytest.raises(NoVariable) as refused:
            chosen(arrays, wish, Path("a.mat"), "y")
        assert f"no such variable{hint}; allowed: ACC, a, acc_y" in str(refused.value)


@pytest.mark.parametrize(("count", "shown"), [(12, "v11"), (13, "v11 and 1 more")])
def test_a_dozen_names_are_shown(count: int, shown: str) -> None:
    arrays = {f"v{number:02}": np.zeros(3) for number in range(count)}
    with pytest.raises(NoVariable) as refused:
        chosen(arrays, "absent", Path("a.mat"), "y")
    assert str(refused.value).endswith(f"v10, {shown}")


@pytest.mark.parametrize("ending", ["csv", "txt", "tsv", "TSV", "tsv.gz", "txt.GZ"])
def test_an_ending_of_tables_says_so_in_capitals_and_packed_too(ending: str) -> None:
    assert file_format(Path(f"a.{ending}"), None) == "csv"


def test_a_stated_format_goes_before_an_ending_of_packed_files() -> None:
    assert file_format(Path("a.xz"), "npy") == "npy"
    with pytest.raises(BadInput, match="is packed"):
        file_format(Path("a.xz"), None)


def test_a_table_of_names_alone_has_columns_without_numbers(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("t,acc\n")
    columns = read_arrays(tmp_path / "a.csv", None, PLAIN)
    assert {name: column.tolist() for name, column in columns.items()} == {"t": [], "acc": []}


def test_a_chunk_of_a_wave_file_that_nobody_knows_is_passed_over(tmp_path: Path) -> None:
    path = tmp_path / "a.wav"
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(8000)
        file.writeframes(np.arange(400, dtype="<i2").tobytes())
    whole = path.read_bytes()
    data = whole.index(b"data")
    body = whole[8:data] + struct.pack("<4sI4s", b"calb", 4, b"1.25") + whole[data:]
    path.write_bytes(struct.pack("<4sI", b"RIFF", len(body)) + body)
    assert read_arrays(path, None, PLAIN)["data"].tolist() == (np.arange(400) / 32768.0).tolist()


def test_columns_without_a_name_may_be_several(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("t,,,a\n1,2,3,4\n5,6,7,8\n")
    columns = read_csv(tmp_path / "a.csv", PLAIN)
    assert columns["a"].tolist() == [4.0, 8.0]


@pytest.mark.parametrize("cell", ["", "NaN", "NA", "n/a", "null", "None", "-"])
def test_what_stands_for_a_missing_sample_is_no_word(cell: str, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(f"a,b\n1,2\n3,4\n5,{cell}\n7,8\n")
    columns = read_csv(tmp_path / "a.csv", PLAIN)
    assert np.isnan(columns["b"]).tolist() == [False, False, True, False]
    assert columns.odd == {"b": (4, cell)}
    assert not columns.worded


def test_a_number_with_a_sign_is_not_taken_for_the_decimals_of_the_one_before(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("1,-05\n2,07\n3,-04\n")
    columns = read_csv(tmp_path / "a.csv", CsvLayout(header=False))
    assert {name: column.tolist() for name, column in columns.items()} == {"1": [1, 2, 3], "2": [-5, 7, -4]}

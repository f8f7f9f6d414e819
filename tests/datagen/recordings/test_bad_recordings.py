"""Each way in which a SPEC or a file can be wrong ends in one clear line, and nothing is written."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import run
from imports import Bring, Mat, noise, refusal
from scipy.io import wavfile

from datagen.corpus import Corpus
from datagen.corpus_files.manifest import write_manifest
from datagen.errors import BadInput
from datagen.inspection.check import check_corpus
from datagen.recordings import importing
from datagen.recordings.opened_files import remembered_files, source_hash
from datagen.recordings.spec import load_spec
from datagen.recordings.unchanged import require_unchanged

GOOD = '[[recording]]\nname = "all"\nfiles = "*.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (('y = "sig"', 'y = "sog"'), 'a.mat: y = "sog": the file has no such variable; did you mean "sig"?; allowed'),
        (('y = "sig"', 'y = "SIG"'), 'a.mat: y = "SIG": the file has no such variable; did you mean "sig"?; allowed'),
        (("rate_hz = 1000\n", ""), "spec.toml: recording[1] (all): rate_hz: the sampling rate is not given"),
        (("rate_hz = 1000", "rate_hz = 0"), "spec.toml, line 6: recording[1].rate_hz = 0; allowed: a number from 100"),
        (("rate_hz = 1000", "rate_hz = -5"), "recording[1].rate_hz = -5; allowed: a number from 100 to 1e+07"),
        (('unit = "g"\n', ""), "recording[1] (all): unit: the unit of the samples is not given; allowed: m/s2, g"),
        (('unit = "g"', 'unit = "G"'), 'line 5: recording[1].unit = "G"; allowed: m/s2, g'),
        (('unit = "g"', 'unit = "mm/s"'), "is that of a velocity; allowed: acceleration in m/s2 or g: differ"),
        (('unit = "g"', 'unit = "mm/s2"'), 'is written with a scale; allowed: unit = "m/s2" and scale = 0.001'),
        (('unit = "g"', 'unit = "mV"'), 'allowed: m/s2, g; volts of a sensor need a scale: unit = "g" and scale = 10'),
        (('"*.mat"', '"/*.mat"'), 'recording[1] (all): files = "/*.mat"; allowed: as in "folder/*.mat"'),
        (('"*.mat"', '""'), 'recording[1] (all): files = ""; allowed: as in'),
        (('"*.mat"', '"*.tam"'), 'recording[1] (all): files = "*.tam": no file below'),
        (('"*.mat"', '"sub"'), 'matches, but a folder; allowed: the files in it, as in "folder/*.mat"'),
        (('y = "sig"', 'x = "sig"\ny = "sig"'), 'y = "sig": is the variable of the axis x too; allowed: another one'),
        (("rate_hz = 1000", 'rate_hz = {variable = "fs", factor = 0}'), "rate_hz.factor = 0; allowed: a number other"),
        (('y = "sig"', 'y = "sig"\ntable = "sub"'), 'spec.toml: table = "sub": this is a folder'),
        (('y = "sig"', 'y = "sig"\ntable = "t.csv"'), 'spec.toml: table = "t.csv": no such file'),
    ],
)
def test_a_setting_that_is_wrong_or_missing_is_named(
    change: tuple[str, str], message: str, bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    (tmp_path / "sub").mkdir()
    assert message in refusal(bring, GOOD.replace(*change), tmp_path)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ('location = "iner"', 'location = "iner"; allowed: none, outer, inner, ball, cage, several, unknown; did'),
        ('location = "outer race"', 'ball, cage, several, unknown; did you mean "outer"?'),
        ('location = "normal"', "several, unknown; none means healthy, unknown that nobody said"),
        ('bearing = "SKF 6203"', "allowed: one of these, or its numbers: bearing = {balls = …"),
        ('condition = "broken"', 'condition = "broken"; allowed: healthy, line, extended, unknown'),
        ('condition = "faulty"', "allowed: healthy, line, extended, unknown; it follows from location and extent"),
        ('condition = "heathy"', 'allowed: healthy, line, extended, unknown; did you mean "healthy"?'),
        ('location = "INNER"', 'did you mean "inner"?'),
        ("notes = {Motor = [1]}", "notes.Motor = [1]; allowed: a text in quotes or a number"),
        ('bearing = "skf_6025"', 'bearing: bearing = "skf_6025" is not in the catalogue'),
        ("bearing = {balls = 8, pitch_diameter_mm = 10, ball_diameter_mm = 8}", "8 balls of 8.000 mm do not fit"),
        ("speed_rpm = 5\nspeed_hz = 2", "speed_rpm and speed_hz set the same thing twice"),
        ('speed_rpm = 5\ntach = {variable = "sig"}', "speed_rpm and tach set the same thing twice"),
        ('speed_rpm = {variable = "rpm"}', 'a.mat: speed_rpm = "rpm": the file has no such variable'),
        ('scale = {variable = "sig"}\nscall = 3', 'unknown key; did you mean "scale"?'),
        ("sampling_rate = 12000", 'sampling_rate: unknown key; did you mean "rate_hz"?'),
        ('label = "inner"', 'label: unknown key; did you mean "location"?'),
        ("scale = 0", "spec.toml: recording[1] (all): scale = 0.0; allowed: any number but 0"),
        (
            "to_s = 0.5",
            "to_s = 0.5; allowed: at least 0.016 s between from_s and to_s, both within 0.4 s, the length of a.mat",
        ),
        ("cut_s = 5", "cut_s = 5.0; allowed: 0.016 to 0.4 s, the length of a.mat"),
        ("envelope_band_hz = [100, 600]", "envelope_band_hz = [100.0, 600.0]; allowed: 0 <= low < high <= 500"),
        (
            "envelope_band_hz = [101, 102]",
            "envelope_band_hz = [101.0, 102.0]: contains no line (2.5 Hz apart) of the spectrum of a.mat (400 samples)"
            "; allowed: a band at least 2.5 Hz wide",
        ),
        (
            "cut_s = 0.1\nenvelope_band_hz = [101, 105]",
            "envelope_band_hz = [101.0, 105.0]: contains no line (10 Hz apart) of the spectrum of a.mat (100 samples)",
        ),
        ('location = "none"\nextent_mm = 1', "a healthy bearing has no defect"),
        ('location = "none"\nspalls = 2', "a healthy bearing has no defect"),
        ('location = "outer"\ncondition = "healthy"', "a healthy bearing has no defect"),
        (
            'location = "outer"\ncondition = "extended"\nextent_mm = 1\nbearing = "skf_6205"',
            "the defect covers 0.061 ball spacings, which makes it line",
        ),
        ('bearing = "skf_6205"\nbpfo = 3.6', "bpfo: it already follows from the bearing's geometry"),
        ('tach = {variable = "sig", rate_hz = 1000, threshold = 9}', "pulses from 0 to 0.4 s"),
        ('channel = [{name = "a"}]\n', "the channel has no variable"),
        ('csv = {decimal = ","}', "csv.delimiter: decimal sign and delimiter are the same; allowed: a character other"),
        ("notes = {a = {b = 1}}", "line 8: recording[1].notes.a = {b = 1}; allowed: a text in quotes or a number or"),
        ('rig = "{number}"', 'a.mat: rig = "{number}": is empty for this file; allowed: a name'),
        ("csv = {delimiter = '\"'}", 'csv.delimiter = """: this character is reserved for quotes or line ends'),
    ],
)
def test_a_label_or_setting_that_cannot_be_is_refused(
    more: str, message: str, bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    text = GOOD.replace('y = "sig"\n', "") if "channel" in more else GOOD
    assert message in refusal(bring, text + more + "\n", tmp_path)


def test_a_scale_of_nothing_is_told_of_the_file_that_holds_it(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat", gain=0.0)
    told = refusal(bring, GOOD + 'scale = {variable = "gain"}\n', tmp_path)
    assert told == f"{tmp_path / 'a.mat'}: scale = 0.0; allowed: any number but 0"


@pytest.mark.parametrize(
    ("samples", "message"),
    [
        (
            np.array([0.0, np.nan, np.inf] + [1.0] * 30),
            "2 of 33 samples are not finite numbers, the first at sample 1 (from 0); allowed: finite numbers; "
            "they can be filled where they are empty or NaN, at most 10 in a row and 1% of all",
        ),
        (np.zeros(0), 'y = "sig": holds 0 samples; allowed: at least 16 samples'),
        (np.ones(15), "holds 15 samples"),
        (np.ones((40, 2)).T.reshape(2, 40, 1), "is not a single channel (2x40)"),
        (np.ones(20) * 1j, "holds complex128, not real numbers"),
    ],
    ids=["not finite", "empty", "short", "table", "complex"],
)
def test_samples_that_are_no_recording_are_refused(
    samples: np.ndarray, message: str, bring: Bring, tmp_path: Path
) -> None:
    np.savez(tmp_path / "a.npz", sig=samples)
    assert message in refusal(bring, GOOD.replace("*.mat", "*.npz"), tmp_path)


def test_one_bad_file_among_good_ones_leaves_nothing_behind(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    mat("b.mat")
    (tmp_path / "c.mat").write_bytes((tmp_path / "b.mat").read_bytes()[:200])
    assert "c.mat: cannot be read as a .mat file" in refusal(bring, GOOD, tmp_path)


def test_the_same_samples_twice_are_refused_or_left_out(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat", noise(seed=1))
    mat("b.mat", noise(seed=1))
    message = refusal(bring, GOOD, tmp_path)
    assert 'b.mat: same_samples = "refuse": record "b" has exactly the samples of "a", a.mat (' in message
    assert 'allowed: "skip", which leaves such repeats out, or "keep"' in message
    assert bring('same_samples = "skip"\n' + GOOD).labels["recording"].tolist() == ["a"]


def test_the_same_samples_twice_are_a_repeat_though_another_axis_is_dead(
    bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    column = mat("a.mat", dead=np.zeros(400))
    mat("b.mat", column, dead=np.zeros(400))
    found = refusal(bring, GOOD.replace("a.mat", "*.mat") + 'x = "dead"\n', tmp_path)
    assert 'record "b" has exactly the samples of "a"' in found


def test_a_piece_that_repeats_another_is_left_out_and_those_behind_it_keep_their_samples(
    bring: Bring, mat: Mat
) -> None:
    one, other = noise(100, seed=1), noise(100, seed=2)
    mat("a.mat", np.concatenate([one, one, other]))
    corpus = bring('same_samples = "skip"\n' + GOOD.replace('"g"', '"m/s2"') + "cut_s = 0.1\n")
    assert corpus.labels["recording"].tolist() == ["a#0", "a#2"]
    assert np.array_equal(corpus.to_numpy()[:, :, 0], np.stack([one, other]).astype(np.float32))


def test_a_repeat_that_is_left_out_has_no_say_in_the_split_of_its_bearing_nor_in_the_turns_of_a_record(
    mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat", noise(seed=1))
    mat("b.mat", noise(seed=1))
    mat("c.mat", noise(seed=2))
    (tmp_path / "t.csv").write_text(
        "file,split,bearing_id,speed_hz\na.mat,train,one,20\nb.mat,test,one,1\nc.mat,train,one,15\n"
    )
    (tmp_path / "spec.toml").write_text('name = "mine"\nsame_samples = "skip"\n' + GOOD + 'table = "t.csv"\n')
    found = importing.import_recordings(load_spec(tmp_path / "spec.toml"), tmp_path / "corpus")
    assert found.skipped == ("b",)
    assert found.few_turns == "the shortest record, c, holds 6 turns of the shaft"
    with Corpus(tmp_path / "corpus") as corpus:
        assert corpus.labels["recording"].tolist() == ["a", "c"]
        assert corpus.labels["record"].tolist() == [0, 1]


def test_the_same_samples_at_another_rate_are_no_repeat(bring: Bring, mat: Mat) -> None:
    mat("a.mat", noise(seed=1), fs=1000.0)
    mat("b.mat", noise(seed=1), fs=2000.0)
    text = GOOD.replace("rate_hz = 1000", 'rate_hz = {variable = "fs"}')
    assert bring(text).labels["rate_hz"].tolist() == [1000.0, 2000.0]


def test_the_same_numbers_are_a_repeat_whatever_their_scale(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat", noise(seed=1))
    mat("b.mat", noise(seed=1))
    scaled = '[[recording.override]]\nfiles = "b.mat"\nscale = 1.5\n'
    assert 'record "b" has exactly the samples of "a"' in refusal(bring, GOOD + scaled, tmp_path)


def test_a_name_twice_is_refused(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    message = refusal(bring, GOOD + GOOD.replace('"all"', '"again"'), tmp_path)
    assert 'spec.toml: recording[2] (again): recording = "a": this name is already taken by a.mat' in message


def test_a_bearing_in_two_splits_is_refused(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    mat("b.mat")
    (tmp_path / "t.csv").write_text("file,split,bearing_id\na.mat,train,one\nb.mat,test,one\n")
    message = refusal(bring, GOOD + 'table = "t.csv"\n', tmp_path)
    assert 't.csv, line 3: split = "test": the records of bearing one would be in the splits train and test' in message


def test_records_of_unknown_bearings_may_be_in_several_splits(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    mat("b.mat")
    (tmp_path / "t.csv").write_text("file,split\na.mat,train\nb.mat,test\n")
    corpus = bring(GOOD + 'table = "t.csv"\n')
    assert corpus.labels["split"].tolist() == ["train", "test"]
    assert check_corpus(corpus.folder).sound


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("fil,location\na.mat,inner\n", 't.csv, line 1: fil: unknown column; did you mean "file"?'),
        ("file;load_n\na.mat;1.797,5\n", 't.csv, line 2: load_n = "1.797,5"; allowed: a number from 0 to 1e+07, or'),
        ('file\tload_n\tspeed_rpm\na.mat\t0.5\t"1,797"\n', 't.csv, line 2: speed_rpm = "1,797": other numbers of this'),
        ("file,load_n,load_n\na.mat,1,2\n", "t.csv, line 1: load_n: this column occurs twice"),
        ("load_n\n1\n", "t.csv, line 1: file: this column is missing"),
        ("file,location\n,inner\n", "t.csv, line 2: file: this cell is empty"),
        ("file,location\na.mat\n", "t.csv, line 2: 1 cells, but the table has 2 columns"),
        ("file;load_n\na.mat\n", "t.csv, line 2: 1 cells, but the table has 2 columns"),
        ("file,location\na.mat,iner\n", 't.csv, line 2: location = "iner"; allowed: none, outer, inner'),
        ("file,load_n\na.mat,much\n", 't.csv, line 2: load_n = "much"; allowed: a number from 0 to 1e+07, or'),
        ("file,location\nz.mat,inner\n", "a.mat is not in the table t.csv; allowed: a row for each file"),
        ("file,location\na.mat,inner\nz.mat,inner\n", 't.csv, line 3: file = "z.mat": no such file below'),
        ("file,location\na.mat,inner\nsub,inner\n", 't.csv, line 3: file = "sub": this is a folder below'),
        ("file,location\na.mat,inner\nz.mat|sub,inner\n", 't.csv, line 3: file = "z.mat|sub": this is a folder'),
        ("file,location\nz.mat,inner\na.mat,inner\n", 't.csv, line 2: file = "z.mat": no such file below'),
        ("file,location\n", "t.csv: the table has no rows"),
        ("file,location\n,\n \n", "t.csv: the table has no rows"),
        ('file,location\n"a.mat,inner\n', "t.csv, line 2: not a row of a CSV table: unexpected end of data"),
        ('\nfile,recording\n\na.mat,"a\nb"\n\na.mat\n', "t.csv, line 7: 1 cells, but the table has 2 columns"),
    ],
)
def test_a_wrong_line_of_a_label_table_is_named(
    table: str, message: str, bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    (tmp_path / "sub").mkdir()
    (tmp_path / "t.csv").write_text(table)
    assert message in refusal(bring, GOOD + 'table = "t.csv"\nspeed_hz = 20\n', tmp_path)


def test_a_column_of_notes_that_the_label_table_lacks_is_named(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    (tmp_path / "t.csv").write_text("file,location\na.mat,inner\n")
    message = refusal(bring, GOOD + 'table = "t.csv"\nnote_columns = ["hp"]\n', tmp_path)
    assert message.endswith("t.csv, line 1: hp: this column is missing")


@pytest.mark.parametrize(
    ("cells", "refused"),
    [
        (("-1,500", "2.5"), "-1,500"),
        (("150,000", "2.5"), "150,000"),
        (("1,500", "-2.5"), "1,500"),
        (("-2.5", "+1,500"), "+1,500"),
        (("0,125", "2.5"), ""),  # no thousand begins with 0
        (("1,50", "2.5"), ""),
        (("1,500", "2"), ""),
        (("150", "2.5"), ""),
    ],
)
def test_a_comma_that_may_stand_between_thousands_is_refused_beside_points_alone(
    cells: tuple[str, str], refused: str, bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    mat("b.mat")
    (tmp_path / "t.csv").write_text(f"file;snr_db\na.mat;{cells[0]}\n;\nb.mat;{cells[1]}\n")
    text = GOOD + 'table = "t.csv"\n'
    if refused:
        assert f'snr_db = "{refused}": other numbers of this table have a point' in refusal(bring, text, tmp_path)
    else:
        assert bring(text).labels["snr_db"].tolist() == [float(cell.replace(",", ".")) for cell in cells]


def test_a_table_without_the_column_that_the_samples_should_be_in_is_refused(bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("time,acc\n0,1\n")
    message = refusal(bring, GOOD.replace("*.mat", "*.csv"), tmp_path)
    assert 'a.csv: y = "sig": the file has no such variable; allowed: acc, time' in message


def test_names_that_hold_the_one_wanted_are_suggested(bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("time,acc_x,acc_y\n0,1,2\n")
    message = refusal(bring, GOOD.replace("*.mat", "*.csv").replace("sig", "ACC"), tmp_path)
    assert 'y = "ACC": the file has no such variable; did you mean "acc_x" or "acc_y"?' in message


@pytest.mark.parametrize("ending", ["mat.gz", "tar.gz", "csv.zip"])
def test_a_packed_file_is_to_be_unpacked(ending: str, bring: Bring, tmp_path: Path) -> None:
    (tmp_path / f"a.{ending}").write_bytes(b"x")
    message = refusal(bring, GOOD.replace("*.mat", f"*.{ending}"), tmp_path)
    assert f"a.{ending}: is packed; allowed: the file unpacked" in message


def test_a_rate_that_contradicts_the_wave_file_is_refused(bring: Bring, tmp_path: Path) -> None:
    import wave

    with wave.open(str(tmp_path / "a.wav"), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(8000)
        file.writeframes(b"\1\0" * 50)
    message = refusal(bring, GOOD.replace("*.mat", "*.wav").replace('"sig"', '"data"'), tmp_path)
    assert "a.wav: rate_hz = 1000.0: the file states another rate; allowed: 8000" in message


def test_a_folder_that_is_not_empty_is_refused_and_kept(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    bring(GOOD)
    before = (tmp_path / "corpus" / "manifest.json").read_bytes()
    with pytest.raises(BadInput, match="this folder is not empty, and an import never adds to what is there"):
        bring(GOOD)
    assert (tmp_path / "corpus" / "manifest.json").read_bytes() == before


def test_the_command_ends_with_2_and_one_line_without_a_traceback(tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text('name = "x"\n' + GOOD)
    for spec in (tmp_path / "s.toml", tmp_path / "none.toml", Path("cwru")):
        done = run("import", spec, "--out", tmp_path / "c")
        assert done.exit_code == 2
        assert done.stderr.startswith("error: ")
        assert done.stderr.count("\n") == 1
    assert not (tmp_path / "c").exists()


@pytest.mark.parametrize("trouble", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_an_import_that_breaks_off_while_writing_leaves_nothing(
    trouble: BaseException, bring: Bring, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def breaks(*_: object) -> None:
        raise trouble

    mat("a.mat")
    monkeypatch.setattr("datagen.recordings.importing.write_index", breaks)
    with pytest.raises((BadInput, KeyboardInterrupt)):
        bring(GOOD)
    assert {path.name for path in tmp_path.iterdir()} == {"a.mat", "spec.toml"}


def test_a_file_that_changes_during_the_import_is_noticed(
    bring: Bring, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def meddling(path: Path) -> str:
        mat("a.mat", noise(seed=99))
        return source_hash(path)

    mat("a.mat", noise(seed=1))
    mat("b.mat", noise(seed=2))  # read last, so that a.mat is no longer remembered
    # The hashes are taken when all files have been checked, and before they are read again.
    monkeypatch.setattr("datagen.recordings.importing.source_hash", meddling)
    with pytest.raises(BadInput, match=r"a\.mat: the file changed while it was being imported"):
        bring(GOOD)
    assert not (tmp_path / "corpus").exists()


def changed(path: Path) -> None:
    """Write the file again with its bytes in reverse, at a time that any clock tells from that of its first version."""
    then = path.stat().st_mtime_ns
    path.write_bytes(path.read_bytes()[::-1])
    os.utime(path, ns=(then + 10**9, then + 10**9))


@pytest.mark.parametrize("moment", ["source_hash", "write_index", "write_manifest"])
def test_a_single_file_that_changes_during_the_import_is_noticed(
    moment: str, bring: Bring, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    step = getattr(importing, moment)

    def meddling(*arguments: object) -> object:
        changed(tmp_path / "a.mat")
        return step(*arguments)

    mat("a.mat")
    monkeypatch.setattr(importing, moment, meddling)
    with pytest.raises(BadInput, match=r"a\.mat: the file changed while it was being imported"):
        bring(GOOD)
    assert {path.name for path in tmp_path.iterdir()} == {"a.mat", "spec.toml"}


@pytest.mark.parametrize("change", [Path.unlink, lambda path: path.write_text("file,location\na.mat,outer\n")])
def test_a_table_of_labels_that_changes_during_the_import_is_noticed(
    change: Callable[[Path], object], bring: Bring, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    table = tmp_path / "t.csv"

    def meddling(*arguments: Any) -> None:
        change(table)
        write_manifest(*arguments)

    mat("a.mat")
    table.write_text("file,location\na.mat,inner \n")
    monkeypatch.setattr(importing, "write_manifest", meddling)
    with pytest.raises(BadInput, match=r"t\.csv: (no such file|the file changed while it was being imported)"):
        bring(GOOD.replace("files =", "table = 't.csv'\nfiles ="))
    assert not (tmp_path / "corpus").exists()


def test_a_file_that_changed_between_two_imports_is_no_matter(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat", noise(seed=1))
    before = bring(GOOD, "one").waveform(0)
    mat("a.mat", noise(seed=2))
    assert not np.array_equal(bring(GOOD, "two").waveform(0), before)


def test_a_cut_of_sixteen_samples_is_the_shortest(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    message = refusal(bring, GOOD + "cut_s = 0.015\n", tmp_path)
    assert "cut_s = 0.015; allowed: 0.016 to 0.4 s, the length of a.mat" in message
    part = refusal(bring, GOOD + "cut_s = 0.3\nto_s = 0.2\n", tmp_path)
    assert "cut_s = 0.3; allowed: 0.016 to 0.2 s, the part from from_s to to_s of a.mat" in part
    assert len(bring(GOOD + "cut_s = 0.016\n").labels) == 25  # of 400 samples


@pytest.mark.parametrize("changed", ["nothing", "samples", "size", "file"])
def test_a_file_is_another_by_its_size_its_time_or_where_it_lies_alone(changed: str, tmp_path: Path) -> None:
    path, other = tmp_path / "a", tmp_path / "b"
    path.write_bytes(b"abcd")
    other.write_bytes(b"efgh")
    stamp = path.stat().st_mtime_ns
    with remembered_files():
        require_unchanged(path)
        if changed == "file":
            other.replace(path)
        else:
            path.write_bytes({"nothing": b"abcd", "samples": b"efgh", "size": b"abcde"}[changed])
        # Programs that keep the time of what they copy set it.
        os.utime(path, ns=(stamp, stamp + (changed == "samples")))
        if changed == "nothing":
            require_unchanged(path)
        else:
            with pytest.raises(BadInput, match="the file changed while it was being imported"):
                require_unchanged(path)


def test_a_wave_file_of_a_rate_that_no_recording_has_is_refused(bring: Bring, tmp_path: Path) -> None:
    wavfile.write(tmp_path / "a.wav", 50, np.arange(400, dtype=np.int16))
    spec = '[[recording]]\nname = "all"\nfiles = "*.wav"\nunit = "g"\ny = "data"\n'
    with pytest.raises(BadInput, match=r"a\.wav: rate_hz = 50\.0: the file's own; allowed"):
        bring(spec)


@pytest.mark.parametrize("column", ["csv", "channel", "tach", "envelope_band_hz", "notes"])
def test_settings_that_are_no_single_cell_are_no_columns_of_a_label_table(
    column: str, bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    (tmp_path / "t.csv").write_text(f"file,{column}\na.mat,\n")
    assert f"t.csv, line 1: {column}: a label table cannot set this; allowed: stated in [defaults]" in refusal(
        bring, GOOD + 'table = "t.csv"\n', tmp_path
    )


def test_four_figures_before_a_comma_are_no_thousands(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    mat("b.mat")
    (tmp_path / "t.csv").write_text("file;speed_rpm\na.mat;1796,125\nb.mat;1797.5\n")
    assert bring(GOOD + 'table = "t.csv"\n').labels["speed_rpm"].tolist() == [1796.125, 1797.5]


@pytest.mark.parametrize("size", [15, 16])
def test_a_recording_of_sixteen_samples_is_the_shortest(size: int, bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat", noise(size))
    if size == 16:
        assert bring(GOOD).waveform(0).shape == (16, 1)
    else:
        assert 'y = "sig": holds 15 samples; allowed: at least 16 samples' in refusal(bring, GOOD, tmp_path)


def test_points_and_commas_of_notes_and_names_say_nothing_of_the_numbers_of_a_label_table(
    bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    mat("b.mat")
    (tmp_path / "t.csv").write_text("file;snr_db;hp;bearing_id\na.mat;2.5;1,500;3,500\nb.mat;3.5;2;4.5\n")
    labels = bring(GOOD + 'table = "t.csv"\nnote_columns = ["hp"]\n').labels
    assert labels["snr_db"].tolist() == [2.5, 3.5]
    assert labels["bearing_id"].tolist() == ["3,500", "4.5"]


def test_a_variable_without_samples_is_told_as_such(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat", other=np.zeros((0, 0)))
    assert 'y = "other": holds 0 samples; ' in refusal(bring, GOOD.replace('"sig"', '"other"'), tmp_path)


def test_one_number_is_no_channel(bring: Bring, tmp_path: Path) -> None:
    np.savez(tmp_path / "a.npz", sig=np.float64(5.0))
    assert 'y = "sig": is not a single channel (one number); ' in refusal(bring, GOOD.replace(".mat", ".npz"), tmp_path)


@pytest.mark.parametrize("pattern", [".", "/a/*.mat", ""])
def test_a_pattern_that_is_none_is_refused_with_one_that_is(
    pattern: str, bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    message = refusal(bring, GOOD.replace("*.mat", pattern), tmp_path)
    assert f'files = "{pattern}"; allowed: ' in message

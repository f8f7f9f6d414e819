"""Finding the files of a large set, among those that systems leave beside them."""

from __future__ import annotations

import os
from pathlib import Path, PurePosixPath
from unicodedata import normalize

import pytest
from imports import Bring, Mat

from datagen.errors import BadInput
from datagen.recordings import file_names, importing
from datagen.recordings.file_names import FileNames, by_number
from datagen.recordings.spec import Spec, load_spec

SPEC = '[[recording]]\nname = "all"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'


def load_spec_of(folder: Path, text: str) -> Spec:
    (folder / "spec.toml").write_text(f'name = "mine"\n{text}')
    return load_spec(folder / "spec.toml")


def names(*known: str) -> FileNames:
    return FileNames({Path("/root") / name: name for name in known})


def test_a_file_is_found_by_its_own_name_by_that_from_the_root_and_by_a_pattern() -> None:
    known = names("a/1.csv", "a/2.csv", "b/1.csv", "3.csv")
    for wish, found in (
        ("3.csv", ["3.csv"]),
        ("1.csv", ["a/1.csv", "b/1.csv"]),
        ("b/1.csv", ["b/1.csv"]),
        ("/1.csv", []),
        ("a/*", ["a/1.csv", "a/2.csv"]),
        ("[12].csv", ["a/1.csv", "a/2.csv", "b/1.csv"]),
    ):
        assert [known.names[path] for path in known.fitting(wish)] == found


def test_files_of_a_run_come_in_the_order_of_their_numbers(bring: Bring, mat: Mat) -> None:
    for name in ("run 10/1", "run 9/11", "run 9/2", "run 9/10", "run 9/1"):
        mat(f"{name}.mat")
    corpus = bring(SPEC + 'files = "*/*.mat"\nrecording = "{path}"\n')
    assert list(corpus.labels.recording) == ["run 9/1", "run 9/2", "run 9/10", "run 9/11", "run 10/1"]


def test_names_of_one_number_come_in_the_order_of_their_texts() -> None:
    ordered = ["1/2.csv", "01.csv", "1.csv", "1a2.csv", "1a10.csv", "a", "a1b1", "a01b2", "a1b02", "a1b2", "²a.csv"]
    assert [str(path) for path in sorted(map(PurePosixPath, ordered[::-1]), key=by_number)] == ordered


def test_a_name_with_brackets_means_the_file_that_is_called_so() -> None:
    known = names("a [1].csv", "b/a [1].csv", "a 1.csv", "c 1.csv")
    for wish, found in (
        ("a [1].csv", ["a [1].csv", "b/a [1].csv"]),
        ("b/a [1].csv", ["b/a [1].csv"]),
        ("c [1].csv", ["c 1.csv"]),
    ):
        assert [known.names[path] for path in known.fitting(wish)] == found


@pytest.mark.parametrize(
    "more",
    [
        'files = "a [1].mat"\nlocation = "outer"\n',
        'files = "*.mat"\noverride = [{files = "a [1].mat", location = "outer"}]\n',
        'files = "*.mat"\ntable = "t.csv"\n',
    ],
)
def test_a_file_with_brackets_in_its_name_is_found_by_it(more: str, bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a [1].mat")
    (tmp_path / "t.csv").write_text("file,location\na [1].mat,outer\n")
    assert list(bring(SPEC + more).labels.location) == ["outer"]


def test_a_name_may_hold_brackets_and_accents_at_once_and_a_pattern_be_longer_than_any_name(
    bring: Bring, mat: Mat
) -> None:
    stored, said = normalize("NFD", "Mühle [1]"), normalize("NFC", "Mühle [1]")
    mat(f"{stored}.mat")
    mat("Mühle 1.mat")
    assert list(bring(SPEC + f'files = "{said}.mat"\n').labels.recording) == [stored]
    with pytest.raises(BadInput, match=r"no file below .* matches"):
        bring(SPEC + f'files = "*{"x" * 300}"\n', "long")


def test_files_that_a_table_names_outright_are_not_compared_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    known = names("a/1.csv", "a/2.csv")
    monkeypatch.setattr(file_names, "fits", None)
    assert [path.name for path in known.fitting("2.csv")] == ["2.csv"]


def test_an_import_that_takes_long_tells_how_far_it_has_got(
    bring: Bring, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mat("a.mat")
    mat("b.mat")
    bring(SPEC + 'files = "*.mat"\n', "first")
    said: list[str] = []
    for seconds, folder in ((2.0, "second"), (0.0, "third")):
        monkeypatch.setattr(importing, "SECONDS_BETWEEN_STEPS", seconds)
        importing.import_recordings(load_spec(tmp_path / "spec.toml"), tmp_path / folder, step=said.append)
        if seconds:
            assert not said
    assert said == ["checking a.mat, 1 of 2", "checking b.mat, 2 of 2", "writing shard 1 of 1"]


@pytest.mark.parametrize("more", ['files = "**/*.mat"\n', 'table = "t.csv"\n', 'files = "**/*"\ntable = "t.csv"\n'])
def test_files_whose_names_begin_with_a_point_are_passed_over(
    more: str, bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("set/a.mat")
    (tmp_path / "set" / "._a.mat").write_bytes(b"Mac OS X")
    (tmp_path / "set" / ".DS_Store").write_bytes(b"Bud1")
    (tmp_path / "t.csv").write_text("file,location\n*a.mat,inner\n")
    more = more.replace("**/*", "set/*")
    assert bring(SPEC + more).labels["recording"].tolist() == ["a"]
    with pytest.raises(BadInput, match=r"\._a\.mat: cannot be read as a \.mat file"):
        bring(SPEC + 'files = "set/._*"\n', "asked_for")


@pytest.mark.parametrize("unwanted", ['"K2/broken.mat"', '"broken.mat"', '["K1/x*", "K2/*"]'])
def test_files_that_are_not_wanted_are_left_out_unread(unwanted: str, bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("K1/good.mat")
    for name in ("K1/x.mat", "K2/broken.mat") if "K1" in unwanted else ("K2/broken.mat",):
        mat(name)
        (tmp_path / name).write_bytes(b"broken")
    corpus = bring(SPEC + f'files = "K?/*.mat"\nleave_out = {unwanted}\n')
    assert corpus.labels["source_file"].tolist() == ["K1/good.mat"]


def test_leaving_out_no_file_is_refused_unless_files_may_be_absent(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    spec = SPEC + 'files = "*.mat"\nleave_out = ["b.mat"]\n'
    with pytest.raises(BadInput) as refused:
        bring(spec)
    message = 'recording[1] (all): leave_out = "b.mat": matches none of the files; allowed: a.mat'
    assert str(refused.value) == f"{tmp_path / 'spec.toml'}: {message}"
    assert len(bring(spec + 'absent_files = "skip"\n')) == 1


def test_a_pattern_without_folders_says_nothing_of_them(bring: Bring, mat: Mat) -> None:
    for name in ("new/ib1.mat", "new/n1.mat", "new/old/ob1.mat"):
        mat(name)
    overrides = (
        '{files = "ib*", location = "inner"}, {files = "ob*", location = "outer"}, {files = "n*", location = "none"}'
    )
    labels = bring(SPEC + f'files = "**/*.mat"\noverride = [{overrides}]\n').labels
    assert dict(zip(labels["recording"], labels["location"], strict=True)) == {
        "ib1": "inner",
        "n1": "none",
        "ob1": "outer",
    }


@pytest.mark.parametrize("pattern", ["new/**/b*.mat", "**/new/**/b*", "**/b*.mat"])
def test_two_stars_stand_for_any_folders_or_none_in_an_override_too(pattern: str, bring: Bring, mat: Mat) -> None:
    for name in ("new/b1.mat", "new/deep/b2.mat", "new/deep/er/b3.mat", "new/c.mat"):
        mat(name)
    labels = bring(SPEC + f'files = "new/**/*.mat"\noverride = [{{files = "{pattern}", load_n = 7}}]\n').labels
    assert sorted(labels[labels["load_n"] == 7.0]["recording"]) == ["b1", "b2", "b3"]


def test_a_name_of_a_table_that_several_folders_hold_is_refused(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    for name in ("one/r.mat", "two/r.mat"):
        mat(name)
    (tmp_path / "t.csv").write_text("file\nr.mat\n")
    with pytest.raises(BadInput, match=r"2 files below .* match: one/r\.mat, two/r\.mat"):
        bring(SPEC + 'table = "t.csv"\n')


def test_a_table_alone_leaves_nothing_out(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    (tmp_path / "t.csv").write_text("file\na.mat\n")
    with pytest.raises(BadInput, match=r"leave_out.*the table alone says which files are meant.*with files only"):
        bring(SPEC + 'table = "t.csv"\nleave_out = "b.mat"\n')


@pytest.mark.parametrize("more", ["", 'files = "**/*.mat"\n'])
def test_a_table_may_part_folders_as_windows_does(more: str, bring: Bring, mat: Mat, tmp_path: Path) -> None:
    for name in ("inner/deep/1.mat", "outer/1.mat"):
        mat(name)
    (tmp_path / "t.csv").write_text("file,location\nouter\\1.mat,outer\nno.mat|inner\\deep\\*.mat,inner\n")
    labels = bring(SPEC + 'table = "t.csv"\nrecording = "{folder}"\n' + more).labels
    assert dict(zip(labels["source_file"], labels["location"], strict=True)) == {
        "inner/deep/1.mat": "inner",
        "outer/1.mat": "outer",
    }


def test_files_in_a_linked_folder_have_their_names_from_the_root(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    for name in ("elsewhere/a.mat", "elsewhere/b.mat"):
        mat(name)
    (tmp_path / "set").mkdir()
    (tmp_path / "set" / "link").symlink_to(tmp_path / "elsewhere")
    (tmp_path / "t.csv").write_text("file,speed_rpm\nset/link/a.mat,1500\nset/link/b.mat,1600\n")
    more = 'files = "set/link/*.mat"\nrecording = "{path}"\ntable = "t.csv"\n'
    labels = bring(SPEC + more + 'override = [{files = "set/link/b*", location = "outer"}]\n').labels
    assert labels["recording"].tolist() == ["set/link/a", "set/link/b"]
    assert labels["source_file"].tolist() == ["set/link/a.mat", "set/link/b.mat"]
    assert labels["speed_rpm"].tolist() == [1500.0, 1600.0]
    assert labels["location"].tolist() == ["unknown", "outer"]


def test_a_link_whose_file_is_not_there_is_no_file_to_pass_over_in_silence(
    bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    (tmp_path / "b.mat").symlink_to(tmp_path / "annex" / "b.mat")
    (tmp_path / "c.mat").symlink_to(tmp_path / "a.mat")
    with pytest.raises(
        BadInput, match=r'files = "\*\.mat": 1 of 3 files are links to what is not there: b\.mat; allow'
    ):
        bring(SPEC + 'files = "*.mat"\n')
    kept = bring(SPEC + 'files = "*.mat"\nleave_out = ["b.mat", "c.mat"]\n', "without")
    assert kept.labels["recording"].tolist() == ["a"]
    (tmp_path / "c.mat").unlink()
    done = importing.import_recordings(
        load_spec_of(tmp_path, SPEC + 'files = "*.mat"\nabsent_files = "skip"\n'), tmp_path / "skipped"
    )
    assert (done.absent, done.records) == (("b.mat",), 1)


@pytest.mark.parametrize(("written", "stored"), [("NFC", "NFD"), ("NFD", "NFC")])
def test_a_name_with_accents_is_found_however_a_system_writes_them(
    written: str, stored: str, bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat(normalize(stored, "Mühle.mat"))
    said = normalize(written, "Mühle.mat")
    (tmp_path / "t.csv").write_text(f"file,load_n\n{said},7\n", encoding="utf-8")
    for number, more in enumerate(
        (
            f'files = "{said[:-5]}*"\noverride = [{{files = "{said}", load_n = 7}}]\n',
            'table = "t.csv"\n',
            'files = "*.mat"\ntable = "t.csv"\n',
        )
    ):
        assert bring(SPEC + more, f"out{number}").labels["load_n"].tolist() == [7.0]


def test_a_table_in_another_encoding_is_refused_with_the_one_to_save_it_in(
    bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("Mühle.mat")
    (tmp_path / "t.csv").write_bytes("file,load_n\nMühle.mat,7\n".encode("cp1252"))
    with pytest.raises(BadInput, match=r"t\.csv: not a text file in utf-8; allowed: the text saved in utf-8$"):
        bring(SPEC + 'table = "t.csv"\n')


def test_a_name_that_is_not_utf_8_is_refused_before_anything_is_read(
    bring: Bring, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mat("good.mat")
    os.rename(tmp_path / "good.mat", os.fsencode(tmp_path) + b"/M\xfchle.mat")
    monkeypatch.setattr(importing, "read_recording", lambda *request: pytest.fail("was read"))
    with pytest.raises(BadInput, match=r'M\\udcfchle\.mat": the name of this file is not UTF-8; allowed: the file re'):
        bring(SPEC + 'files = "*.mat"\n')


def test_a_name_too_long_for_a_file_is_refused_where_a_table_has_it(bring: Bring, tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text(f"file,load_n\n{'a' * 300},7\n")
    with pytest.raises(BadInput, match=r't\.csv, line 2: file = "aaaa.*: no such file below'):
        bring(SPEC + 'table = "t.csv"\n')


def test_a_table_beside_the_spec_goes_before_one_of_that_name_below_the_root(
    bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("below/a.mat")
    (tmp_path / "t.csv").write_text("file,location\na.mat,inner\n")
    (tmp_path / "below" / "t.csv").write_text("file,location\na.mat,outer\n")
    spec = 'root = "below"\n[[recording]]\nname = "all"\ntable = "t.csv"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    assert bring(spec).labels["location"].tolist() == ["inner"]


def test_a_pattern_without_a_file_is_told_as_absent(mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    spec = load_spec_of(tmp_path, SPEC + 'files = ["a.mat", "b*.mat"]\nabsent_files = "skip"\n')
    assert importing.import_recordings(spec, tmp_path / "out").absent == ("b*.mat",)


def test_several_rows_of_a_table_about_one_file_that_a_pattern_finds_are_as_many_records(
    bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    (tmp_path / "t.csv").write_text("file,recording,to_s,location\na.mat,all,,inner\na.mat,half,0.2,outer\n")
    labels = bring(SPEC + 'files = "*.mat"\ntable = "t.csv"\n').labels
    assert labels[["recording", "duration_s", "location"]].values.tolist() == [
        ["all", 0.4, "inner"], ["half", 0.2, "outer"],
    ]  # fmt: skip


def test_a_table_may_lie_below_the_root_alone(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("below/a.mat")
    (tmp_path / "below" / "t.csv").write_text("file,location\na.mat,outer\n")
    spec = 'root = "below"\n[[recording]]\nname = "all"\ntable = "t.csv"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    assert bring(spec).labels["location"].tolist() == ["outer"]


def test_a_folder_below_the_root_is_no_table_and_is_called_what_it_is(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("below/sub/a.mat")
    with pytest.raises(BadInput, match=r'spec\.toml: table = "sub": this is a folder'):
        bring('root = "below"\n' + SPEC + 'table = "sub"\n')


def test_of_many_files_that_one_name_of_a_table_means_a_few_are_named(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    for folder in range(12):
        mat(f"{folder}/r.mat")
    (tmp_path / "t.csv").write_text("file\nr.mat\n")
    with pytest.raises(BadInput) as refused:
        bring(SPEC + 'table = "t.csv"\n')
    assert f"12 files below {tmp_path} match: 0/r.mat, 1/r.mat, " in str(refused.value)
    assert str(refused.value).count("/r.mat") == 4


def test_of_the_names_that_a_row_offers_the_first_is_told_as_absent(mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    (tmp_path / "t.csv").write_text("file\na.mat\nb.mat|c.mat\n")
    spec = load_spec_of(tmp_path, SPEC + 'table = "t.csv"\nabsent_files = "skip"\n')
    assert importing.import_recordings(spec, tmp_path / "out").absent == ("b.mat",)


def test_files_of_several_patterns_come_in_the_order_of_the_patterns(bring: Bring, mat: Mat) -> None:
    for name in ("a1", "a2", "c1"):
        mat(f"{name}.mat")
    corpus = bring(SPEC + 'files = ["c*.mat", "a2.mat", "a*.mat"]\n')
    assert corpus.labels["recording"].tolist() == ["c1", "a2", "a1"]

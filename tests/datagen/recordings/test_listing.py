"""Finding the files of a large set, among those that systems leave beside them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from datagen.corpus import Corpus
from datagen.errors import BadInput
from datagen.recordings import file_names, importing
from datagen.recordings.file_names import FileNames
from datagen.recordings.spec import load_spec

Bring = Callable[..., Corpus]
Mat = Callable[..., np.ndarray]
SPEC = '[[recording]]\nname = "all"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'


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


def test_files_that_a_table_names_outright_are_not_compared_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    known = names("a/1.csv", "a/2.csv")
    monkeypatch.setattr(file_names, "fnmatch", None)
    assert [path.name for path in known.fitting("2.csv")] == ["2.csv"]


def test_an_import_that_takes_long_tells_how_far_it_has_got(
    bring: Bring, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mat("a.mat")
    mat("b.mat")
    bring(SPEC + 'files = "*.mat"\n', "first")
    said: list[str] = []
    for seconds, folder in ((2.0, "second"), (0.0, "third")):
        monkeypatch.setattr(importing, "SECONDS_UNTOLD", seconds)
        importing.import_recordings(load_spec(tmp_path / "spec.toml"), tmp_path / folder, tell=said.append)
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

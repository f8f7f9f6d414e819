"""Where an import is put: whole or not at all, in nobody's way, and with whoever is to blame named."""

from __future__ import annotations

import errno
import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from command_line import run
from imports import SPEC, Bring, Mat

from datagen.errors import BadInput
from datagen.files import places
from datagen.files.digest import file_hash
from datagen.recordings.importing import import_recordings
from datagen.recordings.listing import Request
from datagen.recordings.recorded import Recorded, read_recording
from datagen.recordings.spec import load_spec
from datagen.recordings.staging import staged


def test_an_import_that_fails_leaves_no_folder(mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mat("a.mat")
    text = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    (tmp_path / "spec.toml").write_text('name = "mine"\n' + text)

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("datagen.recordings.importing.write_shard", full)
    with pytest.raises(BadInput, match="cannot write here: No space left on device"):
        import_recordings(load_spec(tmp_path / "spec.toml"), tmp_path / "new" / "deep" / "corpus")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.mat", "spec.toml"]


def test_the_current_folder_is_refused_before_anything_is_read(
    mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mat("a.mat")
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    (tmp_path / "spec.toml").write_text(
        'name = "set"\n[[recording]]\nname = "all"\nfiles = "absent.mat"\ny = "sig"\nunit = "g"\n'
    )
    code, _, message = run("import", tmp_path / "spec.toml", "--out", ".")
    assert code == 2
    assert "the current one cannot be replaced; allowed: another folder, new or empty" in message
    assert list(here.iterdir()) == []


@pytest.mark.parametrize("cause", ["mounted", "parent"])
def test_a_folder_that_cannot_be_replaced_is_refused_before_anything_is_read(
    cause: str, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mat("a.mat")
    parent = tmp_path / "parent"
    out = parent / "out"
    out.mkdir(parents=True)
    if cause == "mounted":
        monkeypatch.setattr(Path, "is_mount", lambda path: path == out)
    else:
        monkeypatch.setattr(places, "is_writable", lambda folder: folder != parent)
    (tmp_path / "spec.toml").write_text(
        'name = "set"\n[[recording]]\nname = "all"\nfiles = "absent.mat"\ny = "sig"\nunit = "g"\n'
    )
    code, _, message = run("import", tmp_path / "spec.toml", "--out", out)
    assert code == 2
    assert {"mounted": "mounted on cannot be replaced", "parent": f"cannot write into {parent}"}[cause] in message


def test_a_relative_folder_is_put_where_it_says(mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mat("a.mat")
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    text = 'name = "set"\n[[recording]]\nname = "all"\nfiles = "a.mat"\ny = "sig"\nunit = "g"\nrate_hz = 5000\n'
    (tmp_path / "spec.toml").write_text(text)
    assert run("import", tmp_path / "spec.toml", "--out", "../out")[0] == 0
    assert run("check", tmp_path / "out")[0] == 0


def test_what_killed_imports_of_the_name_left_is_swept_and_nothing_else(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    host = socket.gethostname()
    dead = [tmp_path / f".corpus.{host}.{number}.part" for number in (gone.pid, 10**30)]  # no process has the latter
    others = [
        tmp_path / f".corpus.{host}.{os.getppid()}.part",  # of a process that lives
        tmp_path / f".corpus.elsewhere{host}.{gone.pid}.part",  # of another computer, whose processes are unknown
        tmp_path / f".other.{host}.{gone.pid}.part",
        tmp_path / f".corpus-{host}-{gone.pid}.part",
        tmp_path / f".corpus.{host}.mine.part",
    ]
    for path in (*dead, *others):
        (path / "shards").mkdir(parents=True)
    mat("a.mat")
    bring('[[recording]]\nname = "a"\nfiles = "a.mat"\ny = "sig"\nunit = "g"\nrate_hz = 1000\n')
    assert not any(path.exists() for path in dead)
    assert all(path.is_dir() for path in others)
    assert sorted(tmp_path.glob(".*")) == sorted(others)


def test_what_the_import_of_another_user_fills_is_left(
    bring: Bring, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def forbidden(*_: int) -> None:
        raise PermissionError(errno.EPERM, "Operation not permitted")

    monkeypatch.setattr(os, "kill", forbidden)
    others = tmp_path / f".corpus.{socket.gethostname()}.{os.getppid()}.part"
    others.mkdir()
    mat("a.mat")
    assert len(bring(SPEC)) == 1
    assert others.is_dir()


def test_what_an_import_of_the_same_number_left_is_in_nobodys_way(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    left = tmp_path / f".corpus.{socket.gethostname()}.{os.getpid()}.part" / "shards"
    left.mkdir(parents=True)
    (left / "shard_000007.nc").write_bytes(b"half")
    mat("a.mat")
    assert len(bring(SPEC)) == 1
    assert not (tmp_path / "corpus" / "shards" / "shard_000007.nc").exists()
    assert not list(tmp_path.glob(".*"))


def test_an_import_fills_the_empty_folder_that_a_link_leads_to(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    (tmp_path / "large disk").mkdir()
    (tmp_path / "corpus").symlink_to(tmp_path / "large disk")
    mat("a.mat")
    assert len(bring(SPEC)) == 1
    assert (tmp_path / "corpus").is_symlink()
    assert (tmp_path / "large disk" / "manifest.json").is_file()


def test_a_full_disk_is_told_of_the_folder_that_is_written(
    bring: Bring, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    mat("a.mat")
    monkeypatch.setattr("datagen.corpus_files.shard.write_atomically", full)
    with pytest.raises(BadInput) as problem:
        bring(SPEC)
    assert str(problem.value) == f"{tmp_path / 'corpus'}: --out: cannot write here: No space left on device"
    assert not (tmp_path / "corpus").exists()


def test_a_recording_that_cannot_be_read_again_is_named_and_not_the_folder_that_is_written(
    bring: Bring, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Request] = []

    def read_once(request: Request, _: object = None) -> Iterator[Recorded]:
        asked.append(request)
        if len(asked) > 1:
            raise OSError(errno.EIO, "Input/output error", "a.mat")
        return read_recording(request)

    mat("a.mat")
    for module in ("import_plan", "importing"):
        monkeypatch.setattr(f"datagen.recordings.{module}.read_recording", read_once)
    with pytest.raises(OSError, match=r"Input/output error: 'a\.mat'"):
        bring(SPEC)
    assert len(asked) == 2
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.mat", "spec.toml"]


def test_a_recording_that_says_something_else_when_it_is_read_again_is_refused(
    bring: Bring, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def read_changed(request: Request, _: object = None) -> Iterator[Recorded]:
        return (replace(record, content="another") for record in read_recording(request))

    mat("a.mat")
    monkeypatch.setattr("datagen.recordings.importing.read_recording", read_changed)
    with pytest.raises(BadInput, match=r"a\.mat: the file changed while it was being imported"):
        bring(SPEC)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.mat", "spec.toml"]


def test_a_recording_that_vanishes_before_its_hash_is_taken_is_named(
    bring: Bring, mat: Mat, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def vanished(path: Path) -> str:
        path.unlink()
        return file_hash(path)

    mat("a.mat")
    monkeypatch.setattr("datagen.recordings.opened_files.file_hash", vanished)
    with pytest.raises(BadInput) as problem:
        bring(SPEC)
    assert str(problem.value) == f"{tmp_path / 'a.mat'}: no such file"


def test_a_folder_that_somebody_filled_meanwhile_is_refused_and_kept(tmp_path: Path) -> None:
    folder = tmp_path / "corpus"
    with pytest.raises(BadInput, match="--out: cannot write here: Directory not empty"), staged(folder):
        (folder / "mine").mkdir(parents=True)
    assert [*tmp_path.rglob("*")] == [folder, folder / "mine"]


def test_a_folder_that_cannot_be_made_is_refused_by_its_name(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    folder = tmp_path / "file" / "corpus"
    with pytest.raises(BadInput) as refused, staged(folder):
        pytest.fail("was filled")
    assert str(refused.value) == f"{folder}: --out: cannot write here: Not a directory"


@pytest.mark.parametrize("name", ["c" * 255, "ü" * 127])
def test_a_folder_of_the_longest_name_is_filled(tmp_path: Path, name: str) -> None:
    with staged(tmp_path / name) as staging:
        (staging / "shards" / "one").write_text("filled")
    assert (tmp_path / name / "shards" / "one").read_text() == "filled"
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_the_name_of_a_filled_folder_is_brought_to_the_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    synced: list[tuple[Path, bool]] = []
    monkeypatch.setattr(
        "datagen.recordings.staging.sync_folder", lambda place: synced.append((place, (place / "corpus").exists()))
    )
    with staged(tmp_path / "corpus"):
        pass
    assert synced == [(tmp_path, True)]

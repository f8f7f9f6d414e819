from __future__ import annotations

import errno
import os
import signal
import stat
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from datagen.errors import BadInput
from datagen.files.atomic import (
    opened_atomically,
    sweep_temporaries,
    write_atomically,
    write_file,
    write_results,
)

ROOT = Path(__file__).parents[3]


def test_a_file_may_have_the_longest_name_there_is(tmp_path: Path) -> None:
    write_file(tmp_path / f"{'x' * 250}.json", b"new", "--json")
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [b"new"]


def test_a_file_written_atomically_replaces_the_old_one_and_leaves_nothing_beside_it(tmp_path: Path) -> None:
    write_atomically(tmp_path / "a", b"old")
    write_atomically(tmp_path / "a", b"new")
    assert [(path.name, path.read_bytes()) for path in tmp_path.iterdir()] == [("a", b"new")]


def test_a_full_disk_leaves_the_old_file_and_no_part_of_the_new_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(descriptor: int) -> None:
        raise OSError(errno.ENOSPC, "no space left on device")

    write_atomically(tmp_path / "a", b"old")
    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="no space"):
        write_atomically(tmp_path / "a", b"new")
    assert [(path.name, path.read_bytes()) for path in tmp_path.iterdir()] == [("a", b"old")]


def test_threads_that_write_one_file_at_once_do_not_write_into_each_others(tmp_path: Path) -> None:
    together = threading.Barrier(2, timeout=60)

    def write(letter: bytes) -> None:
        with opened_atomically(tmp_path / "a") as file:
            for _ in range(3):
                file.write(letter * 100_000)
                together.wait()

    with ThreadPoolExecutor(2) as threads:
        list(threads.map(write, (b"1", b"2")))
    assert (tmp_path / "a").read_bytes() in (b"1" * 300_000, b"2" * 300_000)
    assert [path.name for path in tmp_path.iterdir()] == ["a"]


def test_a_written_file_may_be_read_by_whom_the_user_s_mask_allows(tmp_path: Path) -> None:
    (tmp_path / "plain").write_bytes(b"x")
    write_atomically(tmp_path / "a", b"x")
    assert (tmp_path / "a").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_who_may_read_a_file_stays_who_may_read_what_replaces_it(tmp_path):
    secret = tmp_path / "report.json"
    secret.write_bytes(b"old")
    secret.chmod(0o600)
    write_atomically(secret, b"new")
    assert (secret.read_bytes(), stat.S_IMODE(secret.stat().st_mode)) == (b"new", 0o600)
    secret.chmod(0)  # its owner could not even read what replaces it
    write_atomically(secret, b"newer")
    assert stat.S_IMODE(secret.stat().st_mode) == 0o600


def test_what_a_killed_writer_leaves_is_swept(tmp_path: Path) -> None:
    script = (
        "import os; from pathlib import Path; from datagen.files.atomic import opened_atomically\n"
        f"with opened_atomically(Path({str(tmp_path)!r}) / 'a') as file:\n"
        "    file.write(b'half'); os._exit(9)\n"
    )
    for _ in range(2):
        assert subprocess.run([sys.executable, "-c", script], cwd=ROOT).returncode == 9
    assert not (tmp_path / "a").exists()
    assert len(list(tmp_path.iterdir())) == 2
    sweep_temporaries(tmp_path)
    assert not list(tmp_path.iterdir())


def test_a_writer_killed_at_any_moment_leaves_a_whole_file(tmp_path: Path) -> None:
    script = (
        "import sys; from pathlib import Path; from datagen.files.atomic import write_atomically\n"
        "k = 0\n"
        "while True:\n"
        "    k = (k + 1) % 256\n"
        f"    write_atomically(Path({str(tmp_path)!r}) / 'a', bytes([k]) * 3_000_000)\n"
    )
    for pause in (0.0, 0.003, 0.01, 0.017):
        process = subprocess.Popen([sys.executable, "-c", script], cwd=ROOT)
        (tmp_path / "a").unlink(missing_ok=True)
        while not (tmp_path / "a").exists():
            time.sleep(0.001)
        time.sleep(pause)
        process.send_signal(signal.SIGKILL)
        process.wait()
        content = (tmp_path / "a").read_bytes()
        assert len(content) == 3_000_000
        assert len(set(content)) == 1
    sweep_temporaries(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["a"]


def test_sweeping_deletes_temporaries_and_nothing_else(tmp_path: Path) -> None:
    for name in (".shard_000001.nc.host.7.part", "shard_000001.nc", ".lock", "notes.part"):
        (tmp_path / name).write_bytes(b"x")
    sweep_temporaries(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == [".lock", "notes.part", "shard_000001.nc"]


def test_a_pipe_that_the_user_names_is_written_to_and_not_replaced(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    try:
        write_file(pipe, b"as it is", "--save")
        assert os.read(reader, 100) == b"as it is"
    finally:
        os.close(reader)
    assert pipe.is_fifo()
    assert [path.name for path in tmp_path.iterdir()] == ["pipe"]


def test_a_link_to_a_file_stays_one(tmp_path: Path) -> None:
    (tmp_path / "far").mkdir()
    (tmp_path / "model").symlink_to(tmp_path / "far" / "model")
    for content in (b"a new file", b"written over"):
        write_file(tmp_path / "model", content, "--save")
        assert (tmp_path / "far" / "model").read_bytes() == content
    assert (tmp_path / "model").is_symlink()


def test_a_file_that_cannot_be_written_is_told_with_its_option(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="--save: cannot write this file: No such file or directory"):
        write_file(tmp_path / "absent" / "model", b"", "--save")


@pytest.mark.parametrize("there", [False, True], ids=["a new folder", "a folder that is there"])
def test_results_that_do_not_fit_leave_the_disk_as_it_was(
    there: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(descriptor: int) -> None:
        raise OSError(errno.ENOSPC, "no space left on device")

    monkeypatch.setattr(os, "fsync", full)
    folder = tmp_path / "mine" / "results"
    if there:
        folder.mkdir(parents=True)
    with pytest.raises(BadInput, match="cannot write here: no space left on device"):
        write_results(folder, {"a.json": b"{}", "a.png": b"png"})
    assert folder.exists() == there
    assert sorted(tmp_path.rglob("*")) == ([folder.parent, folder] if there else [])

"""Runs that are killed, interrupted or lose a worker: nothing is left running, nothing is lost, nothing is wrong."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
import uuid
from collections.abc import Callable
from pathlib import Path

import pytest

from datagen.files.atomic import write_atomically
from datagen.inspection.check import check_corpus
from datagen.recipes.recipe import Recipe, load_recipe
from datagen.runs.generate import generate
from datagen.runs.workers import Engine

ROOT = Path(__file__).parents[3]
MARK = "SPALLGEN_TEST_RUN"
PATIENCE = 60.0
Contents = Callable[[Path], dict[int, str]]


class Process:
    """`spallgen generate` in a session of its own, whose processes are known by a mark in their environment."""

    def __init__(self, recipe: Path, out: Path, *options: str) -> None:
        self.mark = uuid.uuid4().hex
        self.shards = out / "shards"
        command = [sys.executable, "-m", "datagen", "generate", str(recipe), "--out", str(out), *options]
        environment = os.environ | {MARK: self.mark}
        self.popen = subprocess.Popen(
            command,
            cwd=ROOT,
            env=environment,
            start_new_session=True,
            # Where a shell runs the tests in its background, they and their children would take no notice of Ctrl-C.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )

    def wait_for_shards(self, count: int) -> None:
        """Return as soon as `count` shards are finished or the run has ended."""
        deadline = time.monotonic() + PATIENCE
        while len(list(self.shards.glob("*.json"))) < count and self.popen.poll() is None:
            assert time.monotonic() < deadline
            time.sleep(0.002)

    def alive(self) -> list[int]:
        """Ids of all running processes that carry the mark."""
        found = []
        for entry in Path("/proc").iterdir():
            try:
                environment = (entry / "environ").read_bytes() if entry.name.isdigit() else b""
            except OSError:
                continue
            if f"{MARK}={self.mark}".encode() in environment:
                found.append(int(entry.name))
        return found

    def workers(self) -> list[int]:
        """Ids of the worker processes."""
        own = [pid for pid in self.alive() if pid != self.popen.pid]
        return [pid for pid in own if b"popen_loky" in Path(f"/proc/{pid}/cmdline").read_bytes()]

    def finish(self) -> tuple[int, str]:
        """Exit code and everything printed, once the run has ended."""
        out, err = self.popen.communicate(timeout=PATIENCE)
        return self.popen.returncode, (out + err).decode()

    def kill(self) -> None:
        """kill -9 of the parent alone."""
        self.popen.kill()
        self.popen.communicate(timeout=PATIENCE)


def wait_until(done: Callable[[], bool], seconds: float) -> bool:
    deadline = time.monotonic() + seconds
    while not done() and time.monotonic() < deadline:
        time.sleep(0.05)
    return done()


@pytest.mark.parametrize("finished", [1, *(pytest.param(some, marks=pytest.mark.slow) for some in (0, 4))])
def test_a_killed_run_leaves_no_process_and_resumes_to_the_same_arrays(
    finished: int, tiny: Recipe, tiny_recipe: Path, expected: dict[int, str], tmp_path: Path, contents: Contents
) -> None:
    process = Process(tiny_recipe, tmp_path / "out", "--workers", "2")
    if finished:
        process.wait_for_shards(finished)
    else:
        assert wait_until(lambda: len(process.workers()) > 0, PATIENCE)
    process.kill()
    assert wait_until(lambda: not process.alive(), 3.0)
    assert contents(tmp_path / "out").items() <= expected.items()
    assert generate(tiny, tmp_path / "out", engine=Engine(workers=1)).complete
    assert contents(tmp_path / "out") == expected
    assert check_corpus(tmp_path / "out").problems == ()


@pytest.mark.slow
def test_a_run_that_loses_a_worker_says_so_and_makes_everything(
    tiny_recipe: Path, expected: dict[int, str], tmp_path: Path, contents: Contents
) -> None:
    process = Process(tiny_recipe, tmp_path / "out", "--workers", "2")
    process.wait_for_shards(1)
    os.kill(process.workers()[0], signal.SIGKILL)
    code, printed = process.finish()
    assert code == 0, printed
    assert "a worker was lost" in printed
    assert "14 of 14 records" in printed.split("a worker was lost")[1]
    assert contents(tmp_path / "out") == expected


def ctrl_c(process: Process) -> None:
    os.killpg(process.popen.pid, signal.SIGINT)


def sigterm(process: Process) -> None:
    process.popen.terminate()


def sigterms_to_all(process: Process) -> None:
    """As `timeout` sends them: to the command, and to its whole group."""
    process.popen.terminate()
    os.killpg(process.popen.pid, signal.SIGTERM)


@pytest.fixture
def longer(tiny_recipe: Path, tmp_path: Path) -> Path:
    """File of a recipe of eight times as many records, so that a signal comes long before its run ends of itself."""
    text = tiny_recipe.read_text().replace("records = 8", "records = 64").replace("records = 6", "records = 48")
    (tmp_path / "longer.toml").write_text(text)
    return tmp_path / "longer.toml"


def ends_well(stop: Callable[[Process], None], code: int, recipe: Path, out: Path) -> None:
    """Assert that a run that is stopped so ends with the code, and leaves a usable corpus and no process."""
    process = Process(recipe, out, "--workers", "2")
    process.wait_for_shards(1)
    stop(process)
    found, printed = process.finish()
    assert found == code, printed
    assert "interrupted; finished records are kept, and the same command continues from there\n" in printed
    assert "Traceback" not in printed
    assert "a worker was lost" not in printed
    assert wait_until(lambda: not process.alive(), 3.0)
    verdict = check_corpus(out)
    assert 2 <= verdict.records < 112
    assert [problem for problem in verdict.problems if "asked for are missing" not in problem] == []


def test_ctrl_c_ends_with_130_and_leaves_a_usable_corpus_and_no_process(
    longer: Path, tmp_path: Path, contents: Contents
) -> None:
    ends_well(ctrl_c, 130, longer, tmp_path / "out")
    for folder in ("out", "uninterrupted"):  # as many records as fill ten shards
        generate(load_recipe(longer), tmp_path / folder, limit=19, engine=Engine(workers=1))
    shards = contents(tmp_path / "uninterrupted")
    assert len(shards) == 10
    assert shards.items() <= contents(tmp_path / "out").items()


def test_what_is_interrupted_between_a_shard_and_its_sidecar_leaves_no_shard(
    tiny: Recipe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(path: Path, data: bytes) -> None:
        if path.suffix == ".json":
            raise KeyboardInterrupt
        write_atomically(path, data)

    monkeypatch.setattr("datagen.corpus_files.shard.write_atomically", interrupted)
    with pytest.raises(KeyboardInterrupt):
        generate(tiny, tmp_path / "out", engine=Engine(workers=1))
    assert list((tmp_path / "out" / "shards").iterdir()) == []


@pytest.mark.slow
@pytest.mark.parametrize("stop", [sigterm, sigterms_to_all])
def test_sigterm_ends_as_ctrl_c_does_with_143(stop: Callable[[Process], None], longer: Path, tmp_path: Path) -> None:
    ends_well(stop, 143, longer, tmp_path / "out")


@pytest.mark.slow
def test_thirty_runs_killed_at_random_all_end_in_the_same_arrays(
    tiny_recipe: Path, expected: dict[int, str], tmp_path: Path, contents: Contents
) -> None:
    chance = random.Random(2026)
    kills = 0
    for corpus in range(100):
        out = tmp_path / f"out{corpus}"
        while len(contents(out)) < len(expected):
            process = Process(tiny_recipe, out, "--workers", "2")
            time.sleep(chance.uniform(0.5, 6.0))
            assert process.popen.poll() in (None, 0)
            kills += process.popen.poll() is None
            process.kill()
            assert wait_until(lambda: not process.alive(), 3.0)  # noqa: B023
            assert contents(out).items() <= expected.items()
        assert contents(out) == expected
        assert Process(tiny_recipe, out).finish()[0] == 0
        assert check_corpus(out).problems == ()
        if kills >= 30:
            return
    pytest.fail(f"only {kills} kills")

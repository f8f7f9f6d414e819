"""What a check advises, by what it found."""

from __future__ import annotations

from pathlib import Path

import pytest

from datagen.corpus_files.format import IMPORTED, SIMULATED, Identity
from datagen.corpus_files.manifest import Manifest
from datagen.inspection.remedy import State, remedy
from datagen.versions import program_hash

AGAIN = "run `spallgen generate` again with the same recipe and --out "
MENDED, FINISHED = "to mend it, ", "it is not complete: to go on where its run stopped, "


def manifest(origin: str = SIMULATED, program: str = "") -> Manifest:
    identity = Identity("r" * 16, "m" * 16, "f" * 16, program or program_hash())
    return Manifest("a", identity, {}, 8, ((0, 8),), origin=origin)


@pytest.mark.parametrize(
    ("state", "beginning"),
    [
        (State((), False, 0, held=True), None),
        (State((), False, 2, held=False), FINISHED),
        (State((), True, 2, held=False), FINISHED),
        (State((), True, 0, held=False), MENDED),
        (State(("gone.nc",), False, 2, held=False), MENDED),
        (State(("gone.nc", "there.nc", "too.nc"), False, 2, held=False), f"{MENDED}delete there.nc, too.nc and "),
    ],
)
def test_what_is_damaged_is_mended_and_what_is_missing_is_finished(
    state: State, beginning: str | None, tmp_path: Path
) -> None:
    for name in ("there.nc", "too.nc"):
        (tmp_path / name).touch()
    advice = "" if beginning is None else f"{beginning}{AGAIN}{tmp_path}"
    assert remedy(manifest(), tmp_path, state) == advice


@pytest.mark.parametrize("damaged", [(), ("there.nc",)])
def test_nothing_is_deleted_while_a_run_is_writing(damaged: tuple[str, ...], tmp_path: Path) -> None:
    (tmp_path / "there.nc").touch()
    advice = remedy(manifest(), tmp_path, State(damaged, True, 2, held=True))
    assert advice.startswith("a run is writing into this folder")
    assert "delete" not in advice


def test_a_corpus_of_another_version_is_mended_by_that(tmp_path: Path) -> None:
    advice = remedy(manifest(program="p" * 16), tmp_path, State((), True, 0, held=False))
    assert advice == f"{MENDED}{AGAIN}{tmp_path}, by the version of spallgen that made it"


def test_recordings_are_imported_again(tmp_path: Path) -> None:
    for state in (State(("a.nc",), False, 0, held=False), State((), False, 1, held=True)):
        advice = "to mend it, delete this folder and import the recordings again"
        assert remedy(manifest(IMPORTED), tmp_path, state) == advice

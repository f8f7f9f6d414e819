"""A shard that is cut short, missing, no file or changed: one message names it and says how to mend it."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import h5py
import pytest
from command_line import run

from datagen.corpus import Corpus
from datagen.corpus_files.shard import shard_path
from datagen.errors import BadInput
from datagen.inspection.check import check_corpus


def cut_short(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:30_000])


def replace_by_folder(path: Path) -> None:
    path.unlink()
    path.mkdir()


def flip(path: Path) -> None:
    with h5py.File(path) as file:
        chunk = file["acceleration"].id.get_chunk_info_by_coord((0, 0, 1))
    content = bytearray(path.read_bytes())
    content[chunk.byte_offset + chunk.size // 2] ^= 16
    path.write_bytes(content)


DAMAGES = {"cut short": cut_short, "missing": Path.unlink, "a folder": replace_by_folder, "flipped": flip}
COMMANDS = {
    "preview": ("preview", "CORPUS", "--out", "OUT.png"),
    "report": ("report", "CORPUS", "--out", "OUT"),
    "size": ("size", "CORPUS", "--split", "all", "--out", "OUT"),
}


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_shard_is_named_and_nothing_is_written(damage: str, command: str, copy: Path, tmp_path: Path) -> None:
    DAMAGES[damage](shard_path(copy, 0))
    out = tmp_path / "out"
    code, _, message = run(*(part.replace("CORPUS", str(copy)).replace("OUT", str(out)) for part in COMMANDS[command]))
    assert code == 2
    assert message.count("\n") == 1
    assert message.startswith(f"error: {shard_path(copy, 0)}: this shard ")
    assert "generate again" in message
    assert "--out" not in message
    assert sorted(path.name for path in tmp_path.iterdir()) == ["copy"]


@pytest.mark.parametrize("damage", ["cut short", "missing", "flipped"])
@pytest.mark.parametrize("read", [Corpus.waveform, Corpus.signal, Corpus.dataset], ids=lambda read: read.__name__)
def test_reading_a_record_of_a_damaged_shard_names_the_shard(
    read: Callable[[Corpus, int], object], damage: str, copy: Path
) -> None:
    DAMAGES[damage](shard_path(copy, 2))
    record = Corpus(copy).labels.query("shard == 'shards/shard_000002.nc'").record.iloc[0]
    with pytest.raises(BadInput, match=r"shard_000002\.nc: this shard (is missing|cannot be read)"):
        read(Corpus(copy), record)


def test_a_shard_that_may_not_be_read_is_named(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def forbidden(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("h5py.File", forbidden)
    monkeypatch.setattr("netCDF4.Dataset", forbidden)
    with pytest.raises(BadInput, match=r"shard_000000\.nc: this shard cannot be read for lack of permission"):
        Corpus(copy).waveform(0)
    monkeypatch.setattr("datagen.inspection.shard_check.file_hash", forbidden)
    verdict = check_corpus(copy)
    assert (
        "shards/shard_000000.nc: it cannot be read for lack of permission; change its permissions" in verdict.problems
    )
    assert verdict.remedy == ""


@pytest.mark.parametrize("damage", DAMAGES)
def test_check_says_how_to_mend_it_and_that_mends_it(
    damage: str, copy: Path, tiny_recipe: Path, expected: dict[int, str], contents: Callable[[Path], dict[int, str]]
) -> None:
    path = shard_path(copy, 2)
    DAMAGES[damage](path)
    code, _, message = run("check", copy)
    assert code == 1
    first = "" if damage == "missing" else "delete shards/shard_000002.nc and "
    again = f"run `spallgen generate` again with the same recipe and --out {copy}\n"
    assert message.endswith(f"to mend it, {first}{again}")
    if path.is_dir():
        shutil.rmtree(path)
    path.unlink(missing_ok=True)
    assert run("generate", tiny_recipe, "--out", copy, "--workers", 1)[0] == 0
    assert check_corpus(copy, remake=0).sound
    assert contents(copy) == expected


def test_going_on_with_a_whole_corpus_says_that_only_sizes_were_compared(copy: Path, tiny_recipe: Path) -> None:
    flip(shard_path(copy, 2))
    code, _, message = run("generate", tiny_recipe, "--out", copy, "--workers", 1)
    assert code == 0
    assert "in files of the right size; `spallgen check` reads them" in message


def test_check_says_how_to_mend_a_wrong_index_and_that_mends_it(copy: Path, tiny_recipe: Path) -> None:
    index = copy / "index.csv"
    index.write_text("\n".join(index.read_text().splitlines()[:-1]) + "\n")
    code, _, message = run("check", copy)
    assert code == 1
    again = f"run `spallgen generate` again with the same recipe and --out {copy}\n"
    assert message.endswith(f"to mend it, {again}")
    assert run("generate", tiny_recipe, "--out", copy, "--workers", 1)[0] == 0
    assert check_corpus(copy, remake=0).sound

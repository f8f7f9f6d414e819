from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray

from datagen.corpus_files.format import Identity, content_hash, to_dataset
from datagen.corpus_files.shard import (
    Failure,
    Sidecar,
    finished_shards,
    read_sidecar,
    shard_path,
    sidecar_path,
    sweep_unfinished,
    write_shard,
)
from datagen.files.digest import file_hash
from datagen.records.record import Record

IDENTITY = Identity("r" * 16, "m" * 16, "f" * 16, "p" * 16)
Maker = Callable[..., Record]


def write(folder: Path, records: list[Record], shard: int = 0, failed: tuple[Failure, ...] = ()) -> Sidecar:
    (folder / "shards").mkdir(exist_ok=True)
    dataset = to_dataset(records, {}) if records else None
    return write_shard(folder, Sidecar(shard, IDENTITY, failed=failed, seconds=1.5), dataset, "zlib")


def test_a_sidecar_reads_back_as_it_was_written_and_vouches_for_its_file(
    tmp_path: Path, make_plain_record: Maker
) -> None:
    written = write(tmp_path, [make_plain_record(3), make_plain_record(5)], failed=(Failure(4, "no equilibrium"),))
    assert read_sidecar(sidecar_path(tmp_path, 0)) == written
    assert written.records == (3, 5)
    assert written.settled == {3, 4, 5}
    assert file_hash(shard_path(tmp_path, 0)) == written.sha256
    assert written.labels["envelope_band_high"] == [200.0, 200.0]


def test_labels_that_do_not_apply_are_null_in_the_sidecar(tmp_path: Path, make_plain_record: Maker) -> None:
    write(tmp_path, [make_plain_record(0), make_plain_record(1)])
    content = json.loads(sidecar_path(tmp_path, 0).read_text(), parse_constant=pytest.fail)
    assert content["labels"]["snr_db"] == [12.5, None]


def test_a_shard_without_a_single_good_record_has_a_sidecar_only(tmp_path: Path) -> None:
    write(tmp_path, [], failed=(Failure(0, "no equilibrium"),))
    assert not shard_path(tmp_path, 0).exists()
    assert [sidecar.settled for sidecar in finished_shards(tmp_path)] == [{0}]


def test_finished_shards_come_by_number_and_copies_of_sidecars_do_not_count(tmp_path: Path) -> None:
    for shard in (1_000_000, 999_999, 2):
        write(tmp_path, [], shard, failed=(Failure(shard, "no equilibrium"),))
    for name in ("shard_000002 (1).json", "shard_000003.json"):
        (tmp_path / "shards" / name).write_bytes(sidecar_path(tmp_path, 2).read_bytes())
    assert [sidecar.shard for sidecar in finished_shards(tmp_path)] == [2, 999_999, 1_000_000]


def test_a_shard_counts_as_finished_only_with_a_readable_sidecar_and_a_file_of_its_size(
    tmp_path: Path, make_plain_record: Maker
) -> None:
    for shard in range(4):
        write(tmp_path, [make_plain_record(shard)], shard)
    with shard_path(tmp_path, 0).open("ab") as file:
        file.write(b"x")
    shard_path(tmp_path, 1).unlink()
    text = sidecar_path(tmp_path, 2).read_text()
    sidecar_path(tmp_path, 2).write_text(text[: len(text) // 2])
    assert [sidecar.shard for sidecar in finished_shards(tmp_path)] == [3]


def test_sweeping_deletes_what_no_sidecar_vouches_for_and_nothing_else(
    tmp_path: Path, make_plain_record: Maker
) -> None:
    for shard in range(2):
        write(tmp_path, [make_plain_record(shard)], shard)
    write(tmp_path, [], 2, failed=(Failure(2, "no equilibrium"),))
    sidecar_path(tmp_path, 0).unlink()
    kept = {
        shard_path(tmp_path, 1),
        *(sidecar_path(tmp_path, shard) for shard in (1, 2)),
        tmp_path / "shards" / "own.nc",
    }
    (tmp_path / "shards" / "own.nc").touch()
    for folder in (tmp_path, tmp_path / "shards"):
        (folder / ".killed.0123.part").touch()
    sweep_unfinished(tmp_path)
    assert {path for path in tmp_path.rglob("*") if path.is_file()} == kept


@pytest.mark.parametrize("text", ["", "null", "[]", "{}", '{"shard": 1}', "\udcff"])
def test_what_is_no_sidecar_reads_as_none(tmp_path: Path, text: str) -> None:
    (tmp_path / "a.json").write_bytes(text.encode("utf-8", "surrogateescape"))
    assert read_sidecar(tmp_path / "a.json") is None


def test_the_same_records_give_the_same_content_hash_and_different_ones_another(
    tmp_path: Path, make_plain_record: Maker
) -> None:
    first, second = make_plain_record(3), make_plain_record(5)
    hashes = {
        write(tmp_path, records).content
        for records in ([first, second], [replace(first), replace(second)], [second, first], [first])
    }
    assert len(hashes) == 3


def test_the_content_hash_is_of_names_dimensions_and_shapes_too() -> None:
    numbers = np.arange(6.0)
    datasets = [
        xarray.Dataset({"a": ("time", numbers)}),
        xarray.Dataset({"b": ("time", numbers)}),
        xarray.Dataset({"a": ("ball", numbers)}),
        xarray.Dataset({"a": (("time", "axis"), numbers.reshape(2, 3))}),
        xarray.Dataset({"a": (("time", "axis"), numbers.reshape(3, 2))}),
    ]
    assert len(set(map(content_hash, datasets))) == len(datasets)

from __future__ import annotations

import math
import tracemalloc
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas
import pytest

from datagen.corpus_files.format import Identity, to_dataset
from datagen.corpus_files.index import index_path, read_index, write_index
from datagen.corpus_files.shard import LABEL_COLUMNS, Failure, Sidecar, finished_shards, write_shard
from datagen.errors import BadInput
from datagen.records.record import Record
from labels.schema import LABELS

Maker = Callable[..., Record]
IDENTITY = Identity("r", "m", "f", "p")


@pytest.fixture
def folder(tmp_path: Path, make_plain_record: Maker) -> Path:
    (tmp_path / "shards").mkdir()
    for shard, indices in enumerate([(0, 3, 6), (1, 2, 8), (4, 5), (7,)]):
        records = [make_plain_record(index, healthy=index == 3) for index in indices]
        write_shard(tmp_path, Sidecar(shard, IDENTITY), to_dataset(records, {}), "zlib")
    assert write_index(tmp_path, finished_shards(tmp_path)) == 9
    return tmp_path


def test_the_index_has_one_row_a_record_in_their_order_with_its_place(folder: Path) -> None:
    plain = pandas.read_csv(index_path(folder))
    assert list(plain["record"]) == list(range(9))
    assert list(plain.columns) == [*LABEL_COLUMNS, "shard", "position"]
    assert list(plain["shard"].str[-5:-3].astype(int)) == [0, 1, 1, 0, 2, 2, 0, 3, 1]
    assert list(plain["position"]) == [0, 0, 1, 1, 0, 1, 2, 0, 2]
    assert b"\r" not in index_path(folder).read_bytes()


def test_rows_keep_the_order_of_the_records_where_the_first_ones_of_a_shard_failed(
    tmp_path: Path, make_plain_record: Maker
) -> None:
    (tmp_path / "shards").mkdir()
    lost = {0: (Failure(0, "lost"),), 1: (Failure(1, "lost"), Failure(3, "lost")), 2: ()}
    for shard, indices in enumerate([(6, 9), (8,), (2, 4)]):
        dataset = to_dataset([make_plain_record(index) for index in indices], {})
        write_shard(tmp_path, Sidecar(shard, IDENTITY, failed=lost[shard]), dataset, "zlib")
    nothing_made = Sidecar(3, IDENTITY, failed=(Failure(5, "lost"),))
    write_index(tmp_path, iter([*finished_shards(tmp_path), nothing_made]))
    assert list(pandas.read_csv(index_path(tmp_path))["record"]) == [2, 4, 6, 8, 9]


def test_the_index_reads_back_with_the_types_of_the_schema(folder: Path) -> None:
    table = read_index(folder)
    kinds = {"str": "OUT", "float64": "f", "int64": "i", "bool": "b"}
    for label in LABELS:
        for column in label.columns:
            dtype = table[column].to_numpy().dtype
            assert dtype.kind in kinds[label.dtype], column
    assert math.isnan(table["snr_db"][1])
    assert table["location"][3] == "none"
    assert table["validity"][0] == ""


def test_an_index_that_somebody_sorted_otherwise_is_read_in_the_order_of_the_records(folder: Path) -> None:
    as_written = read_index(folder)
    header, *rows = index_path(folder).read_text().splitlines()
    index_path(folder).write_text("\n".join([header, *reversed(rows)]) + "\n")
    pandas.testing.assert_frame_equal(read_index(folder), as_written)


def test_every_digit_of_a_number_survives_the_index(tmp_path: Path, make_plain_record: Maker) -> None:
    generator = np.random.default_rng(1)
    records = [make_plain_record(k) for k in range(50)]
    for record in records:
        record.labels["extent_mm"] = float(np.exp(generator.normal(0.0, 20.0)))
    (tmp_path / "shards").mkdir()
    write_shard(tmp_path, Sidecar(0, IDENTITY), to_dataset(records, {}), "zlib")
    write_index(tmp_path, finished_shards(tmp_path))
    assert list(read_index(tmp_path)["extent_mm"]) == [record.labels["extent_mm"] for record in records]


def test_a_folder_without_index_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match=r"no index\.csv"):
        read_index(tmp_path)


def test_an_index_with_a_lost_column_is_refused(folder: Path) -> None:
    read = pandas.read_csv(index_path(folder)).drop(columns="bridged")
    read.to_csv(index_path(folder), index=False)
    with pytest.raises(BadInput, match="not the index of a corpus"):
        read_index(folder)


@pytest.mark.parametrize("column", ["rate_hz", "duration_s"])
def test_an_index_of_records_without_rate_or_duration_is_refused(folder: Path, column: str) -> None:
    read = pandas.read_csv(index_path(folder), keep_default_na=False)
    read[column] = read[column].astype(str)
    read.loc[1, column] = "0.0"
    read.to_csv(index_path(folder), index=False)
    with pytest.raises(BadInput, match=rf"line 3: not the index of a corpus: {column} = 0\.0 is not above 0"):
        read_index(folder)


def test_an_index_is_written_row_by_row_whatever_its_length(tmp_path: Path) -> None:
    def sidecars() -> Iterator[Any]:
        for shard in range(100):
            records = list(range(50 * shard, 50 * shard + 50))
            columns = dict.fromkeys(LABEL_COLUMNS, records)
            yield SimpleNamespace(shard=shard, records=records, settled=set(records), labels=columns)

    tracemalloc.start()
    try:
        assert write_index(tmp_path, sidecars()) == 5000
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert index_path(tmp_path).stat().st_size > 1_000_000
    assert peak < 500_000  # the shard at hand, and buffers

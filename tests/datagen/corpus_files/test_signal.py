"""Signals read by h5py are those that netCDF reads, bit for bit; it is asked wherever that is not sure."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import h5py
import netCDF4
import numpy as np
import pytest

from datagen.corpus import Corpus
from datagen.corpus_files.format import to_dataset
from datagen.corpus_files.signal import quick_signal
from datagen.errors import BadInput
from datagen.files.netcdf import COMPRESSIONS, netcdf_bytes
from datagen.records.record import Record

INDICES = (4, 7, 9)


@pytest.fixture(params=COMPRESSIONS)
def shard(request: pytest.FixtureRequest, make_plain_record: Callable[..., Record], tmp_path: Path) -> Path:
    """A shard of three records with everything that can be stored."""
    path = tmp_path / "shard.nc"
    records = [make_plain_record(index, healthy=index == 7, full=True) for index in INDICES]
    path.write_bytes(netcdf_bytes(to_dataset(records, {"title": "t"}), request.param))
    return path


def test_every_signal_is_the_one_that_netcdf_reads(shard: Path) -> None:
    with netCDF4.Dataset(shard) as file:
        file.set_auto_mask(False)
        signals = [name for name, held in file.variables.items() if held.dimensions[0] == "record" and held.ndim > 1]
        read = {name: file[name][...] for name in signals}
    quick = [name for name in signals if quick_signal(shard, name, 4, 0) is not None]
    assert {"acceleration", "acceleration_clean", "envelope", "stiffness", "cage_angle", "profile_depth"} <= {*quick}
    for name in quick:
        for position, record in enumerate(INDICES):
            found = quick_signal(shard, name, record, position)
            assert found is not None
            assert found.dtype == read[name].dtype
            assert found.flags.c_contiguous
            assert found.shape == read[name].shape[1:]
            assert found.tobytes() == read[name][position].tobytes()


@pytest.mark.parametrize(
    ("variable", "record", "position"),
    [
        ("scenario", 4, 0),  # a text
        ("time", 4, 0),
        ("pass_row", 4, 0),
        ("none", 4, 0),
        ("acceleration", 7, 0),  # another record is there
        ("acceleration", 4, 3),  # and none here
    ],
)
def test_netcdf_is_asked_for_all_else(variable: str, record: int, position: int, shard: Path) -> None:
    assert quick_signal(shard, variable, record, position) is None


def test_netcdf_is_asked_where_h5py_is_missing(shard: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "h5py", None)
    assert quick_signal(shard, "acceleration", 4, 0) is None


def test_netcdf_is_asked_for_numbers_that_others_have_scaled(shard: Path) -> None:
    with netCDF4.Dataset(shard, "a") as file:
        file["acceleration"].scale_factor = 2.0
    assert quick_signal(shard, "acceleration", 4, 0) is None


def test_netcdf_is_asked_for_damaged_chunks_and_files(shard: Path) -> None:
    with h5py.File(shard) as file:
        chunk = file["acceleration"].id.get_chunk_info_by_coord((0, 0, 1))
    content = bytearray(shard.read_bytes())
    content[chunk.byte_offset + chunk.size // 2] ^= 16
    shard.write_bytes(content)
    assert quick_signal(shard, "acceleration", 4, 0) is None
    assert quick_signal(shard, "acceleration", 7, 1) is not None
    shard.write_bytes(content[:3000])
    assert quick_signal(shard, "acceleration", 4, 0) is None
    shard.unlink()
    assert quick_signal(shard, "acceleration", 4, 0) is None


def test_a_corpus_reads_signals_by_h5py_and_refuses_a_record_at_another_place(
    tiny_corpus: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    corpus = Corpus(tiny_corpus)
    monkeypatch.setitem(sys.modules, "h5py", None)
    by_netcdf = [corpus.waveform(record, name) for name in ("acceleration", "stiffness") for record in range(14)]
    monkeypatch.undo()
    corpus.close()
    found = [corpus.waveform(record, name) for name in ("acceleration", "stiffness") for record in range(14)]
    assert all(np.array_equal(one, other) for one, other in zip(found, by_netcdf, strict=True))
    assert not corpus.open_files
    corpus.labels.loc[0, "record"], corpus.labels.loc[1, "record"] = 1, 0
    del corpus._places
    with pytest.raises(BadInput, match="the corpus has changed since its labels were read"):
        corpus.waveform(0)
    corpus.close()

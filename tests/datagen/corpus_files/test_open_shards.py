"""One door to the open shards: a file is nobody else's while it is read."""

from __future__ import annotations

import contextlib
import gc
import multiprocessing
import os
import shutil
import threading
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import netCDF4
import numpy as np
import pytest
from xarray.backends import NetCDF4DataStore

from datagen.corpus import Corpus
from datagen.corpus_files.open_shards import OpenShards
from datagen.errors import BadInput
from datagen.formats.csv_layout import CsvLayout
from datagen.formats.reading import read_arrays
from datagen.sizing.sized_records import sized_records

HELD = 0.2  # s: ample for a thread that does not wait


def waits_while_a_shard_is_read(folder: Path, task: Callable[[], object]) -> bool:
    """Whether a task in another thread ends only after the block in which this one reads a shard."""
    shards = OpenShards(folder)
    done = threading.Event()
    other = threading.Thread(target=lambda: (task(), done.set()))
    last = max(path.name for path in (folder / "shards").glob("*.nc"))
    with shards.reading(f"shards/{last}"):
        other.start()
        waited = not done.wait(HELD)
    other.join()
    shards.close()
    return waited and done.is_set()


def test_nobody_opens_reads_or_closes_a_shard_while_another_thread_reads_one(tiny_corpus: Path) -> None:
    corpus = Corpus(tiny_corpus)
    before = corpus.waveform(0)
    assert np.array_equal(corpus.signal(0), before[:, 1])
    assert waits_while_a_shard_is_read(tiny_corpus, lambda: corpus.signal(0))  # an open file
    assert waits_while_a_shard_is_read(tiny_corpus, lambda: corpus.waveform(0))
    assert waits_while_a_shard_is_read(tiny_corpus, lambda: corpus.axes(0))
    assert waits_while_a_shard_is_read(tiny_corpus, lambda: corpus.dataset(0))
    assert waits_while_a_shard_is_read(tiny_corpus, corpus.close)
    assert np.array_equal(corpus.waveform(0), before)


def test_recordings_and_sized_records_are_read_by_one_thread_at_a_time_too(tiny_corpus: Path, tmp_path: Path) -> None:
    records = sized_records(tiny_corpus)
    next(records)  # its file is open
    assert waits_while_a_shard_is_read(tiny_corpus, lambda: next(records))
    records.close()
    with netCDF4.Dataset(tmp_path / "a.nc", "w") as file:
        file.createDimension("time", 3)
        file.createVariable("acc", "f8", ("time",))[...] = [1.0, 2.0, 3.0]
    arrays = read_arrays(tmp_path / "a.nc", None, CsvLayout())
    assert waits_while_a_shard_is_read(tiny_corpus, lambda: read_arrays(tmp_path / "a.nc", None, CsvLayout()))
    assert waits_while_a_shard_is_read(tiny_corpus, lambda: arrays["acc"])


def test_threads_that_share_a_corpus_read_what_one_thread_reads(
    tiny_corpus: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("datagen.corpus_files.open_shards.OPEN_FILES", 1)  # nearly every reading closes a file
    with Corpus(tiny_corpus) as corpus, ThreadPoolExecutor(8) as pool:
        alone = [corpus.signal(record) for record in range(14)]
        together = list(pool.map(corpus.signal, [*range(14)] * 20))
    assert all(np.array_equal(found, alone[place % 14]) for place, found in enumerate(together))


def test_a_file_is_open_once_however_many_corpora_read_it(tiny_corpus: Path) -> None:
    one, other = OpenShards(tiny_corpus), OpenShards(tiny_corpus)
    shard = min(f"shards/{path.name}" for path in (tiny_corpus / "shards").glob("*.nc"))
    with one.reading(shard) as file, other.reading(shard) as same:
        assert same is file
    one.close()
    assert not one.open_files
    with other.reading(shard) as still:
        assert still is file
        assert still.isopen()
    other.close()
    assert not file.isopen()


def test_a_file_that_is_reached_by_several_paths_is_open_once(tiny_corpus: Path, tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tiny_corpus, target_is_directory=True)
    (tmp_path / "shards").mkdir()
    shard = min(f"shards/{path.name}" for path in (tiny_corpus / "shards").glob("*.nc"))
    os.link(tiny_corpus / shard, tmp_path / shard)
    folders = [tiny_corpus, tmp_path / "link", tmp_path, tiny_corpus / ".." / tiny_corpus.name]
    readers = [OpenShards(folder) for folder in folders]
    opened = []
    for reader in readers:
        with reader.reading(shard) as file:
            opened.append(file)
    assert all(file is opened[0] for file in opened)
    for reader in readers:
        assert opened[0].isopen()
        reader.close()
    assert not opened[0].isopen()


def test_of_more_files_than_are_kept_open_the_one_read_longest_ago_is_closed(
    tiny_corpus: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("datagen.corpus_files.open_shards.OPEN_FILES", 2)
    first, second, third = sorted((tiny_corpus / "shards").glob("*.nc"))[:3]
    shards = OpenShards(tiny_corpus)
    for path in (first, second, first, third):
        with shards.reading(f"shards/{path.name}"):
            pass
    assert shards.open_files == [first.resolve(), third.resolve()]
    shards.close()


def test_a_reader_that_nobody_holds_any_more_has_closed_its_files(tiny_corpus: Path) -> None:
    shards = OpenShards(tiny_corpus)
    with shards.reading("shards/shard_000000.nc") as file:
        pass
    assert file.isopen()
    del shards
    gc.collect()
    assert not file.isopen()


def test_everything_of_a_record_is_read_through_the_file_that_is_open(
    tiny_corpus: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Corpus(tiny_corpus) as corpus:
        text = str(corpus.waveform(0, "scenario"))
        monkeypatch.setattr(NetCDF4DataStore, "open", None)  # which opens what is known by its path
        assert corpus.dataset(0)["scenario"].item() == text


def test_corpora_that_open_read_and_close_the_same_files_in_any_order_do_no_harm(tiny_corpus: Path) -> None:
    # With a handle for each, reading texts crashed in eleven of twelve such orders.
    generator, corpora = np.random.default_rng(3), [Corpus(tiny_corpus) for _ in range(3)]
    texts = [corpora[0].scenario(record) for record in range(14)]
    for _ in range(400):
        corpus, record = corpora[generator.integers(3)], int(generator.integers(14))
        if generator.random() < 0.2:
            corpus.close()
        else:
            assert corpus.scenario(record) == texts[record]
    for corpus in corpora:
        corpus.close()


def read_text(corpus: Corpus, record: int) -> dict[str, object]:
    corpus.signal(record)
    return corpus.scenario(record)


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="this system does not fork")
@pytest.mark.slow
def test_forked_processes_read_what_their_parent_reads_and_so_does_it_afterwards(tiny_corpus: Path) -> None:
    # While the parent's files stayed open, processes that opened and closed larger ones again crashed.
    with Corpus(tiny_corpus) as corpus:
        texts = [read_text(corpus, record) for record in range(14)]
        records = [*range(14)] * 20
        with ProcessPoolExecutor(2, multiprocessing.get_context("fork")) as pool:
            found = list(pool.map(read_text, [corpus] * len(records), records))
        assert found == [texts[record] for record in records]
        assert [corpus.scenario(record) for record in range(14)] == texts


def fork_once() -> None:
    """A process that is forked from this one and ends."""
    child = multiprocessing.get_context("fork").Process(target=int)
    child.start()
    child.join()
    assert child.exitcode == 0


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="this system does not fork")
def test_a_file_that_is_being_read_stays_open_during_a_fork(tiny_corpus: Path) -> None:
    shards = OpenShards(tiny_corpus)
    shard = min(f"shards/{path.name}" for path in (tiny_corpus / "shards").glob("*.nc"))
    with shards.reading(shard) as file:
        fork_once()
        assert file.isopen()
    fork_once()
    assert not shards.open_files
    with shards.reading(shard) as file:
        assert file.isopen()
    shards.close()


def test_an_open_file_keeps_no_chunks_and_other_files_as_many_as_ever(tiny_corpus: Path) -> None:
    usual = netCDF4.get_chunk_cache()
    assert usual[0] > 0
    shards = OpenShards(tiny_corpus)
    with shards.reading("shards/shard_000000.nc") as file:
        assert file["acceleration"].get_var_chunk_cache()[0] == 0
    shards.close()
    assert netCDF4.get_chunk_cache() == usual


@pytest.mark.parametrize("put", [Path.replace, shutil.copyfile], ids=["in its place", "into it"])
def test_a_shard_that_was_made_again_is_opened_again(
    put: Callable[[Path, Path], object], tiny_corpus: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "corpus"
    shutil.copytree(tiny_corpus, folder)
    shard = min((folder / "shards").glob("*.nc"))
    with Corpus(folder) as corpus:
        before = corpus.signal(0)
        with netCDF4.Dataset(tmp_path / "new.nc", "w") as new, netCDF4.Dataset(shard) as old:
            new.createDimension("record", old.dimensions["record"].size)
            new.createDimension("time", 3)
            new.createVariable("acceleration", "f4", ("record", "time"))[...] = 7.0
            new.createVariable("record", "i8", ("record",))[...] = old["record"][...]
        put(tmp_path / "new.nc", shard)
        assert before.shape != (3,)
        assert np.array_equal(corpus.waveform(0), [7.0, 7.0, 7.0])
        assert corpus.open_files == [shard.resolve()]


def test_a_corpus_closes_its_files_at_the_end_of_its_block_whatever_happens_there(tiny_corpus: Path) -> None:
    corpus = Corpus(tiny_corpus)
    with contextlib.suppress(BadInput), corpus as same:
        same.signal(0)
        assert corpus.open_files
        same.waveform(14)  # there is none
    assert not corpus.open_files
    assert np.isfinite(corpus.signal(0)).all()  # and opens them again
    corpus.close()


def test_a_file_that_is_written_anew_in_its_own_place_is_opened_again(tmp_path: Path) -> None:
    """As by a copy over it, which keeps the inode: of two files of one size only the time tells them apart."""
    (tmp_path / "shards").mkdir()
    old, new = tmp_path / "shards" / "a.nc", tmp_path / "b.nc"
    for path, value in ((old, 1.0), (new, 2.0)):
        with netCDF4.Dataset(path, "w") as file:
            file.value = value
    assert old.stat().st_size == new.stat().st_size
    shards = OpenShards(tmp_path)
    with shards.reading("shards/a.nc") as before:
        assert before.value == 1.0
    place = old.stat().st_ino
    shutil.copyfile(new, old)
    os.utime(old, (0, 0))
    assert old.stat().st_ino == place
    with shards.reading("shards/a.nc") as after:
        assert (after.value, before.isopen()) == (2.0, False)
    shards.close()

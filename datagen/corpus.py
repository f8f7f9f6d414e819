"""Reading a corpus: labels without opening a shard, any record in milliseconds, batches, and splits without leakage.

with Corpus("out/quickstart") as corpus:
    x = corpus.to_numpy("acceleration", corpus.labels.query("rig == 'gearbox'").record)
    train, test = next(corpus.folds(5))

Of one record `waveform` gives any stored variable, `signal` the acceleration along one axis, `scenario` what it was
simulated from and `dataset` everything; of many records `to_numpy` gives a variable at once and `batches` in pieces.
"""

from __future__ import annotations

import json
import warnings
from collections import Counter
from collections.abc import Iterable, Iterator
from functools import cached_property
from numbers import Integral
from operator import index
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from datagen.corpus_files.index import read_index
from datagen.corpus_files.manifest import Manifest, read_manifest
from datagen.corpus_files.open_shards import OpenShards
from datagen.corpus_files.signal import quick_signal
from datagen.errors import BadInput
from datagen.files.places import from_home
from labels.schema import UNKNOWN

if TYPE_CHECKING:
    import netCDF4
    import pandas
    import xarray

LARGEST_SEED = 2**32 - 1  # that scikit-learn takes


class Corpus:
    """A corpus in a folder: a sequence of (acceleration (T, axes) in m/s², labels), in the order of the record indices.

    Simulated records have the axes x and y, imported ones those that were recorded.
    It can be handed to `torch.utils.data.DataLoader` and used by several threads; readers of one folder share its open
    files. As a context manager it closes them at the end of the block. Close it before you open a shard by other means:
    HDF5 2.2.0 may crash on texts of a file that is open twice. Raises BadInput if the folder holds no corpus.
    """

    def __init__(self, folder: str | Path) -> None:
        self.folder = from_home(folder)
        self._root = self.folder.absolute()  # the caller may change its directory
        self.manifest: Manifest = read_manifest(self.folder)
        self._shards = OpenShards(self._root)

    def __enter__(self) -> Corpus:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @cached_property
    def labels(self) -> pandas.DataFrame:
        """All labels, one row a record, columns as in labels.schema, plus the record's `shard` and `position` in it."""
        return read_index(self._root)

    @cached_property
    def _places(self) -> dict[int, tuple[str, int]]:
        table = self.labels
        places = zip(table["shard"], table["position"].tolist(), strict=True)
        return dict(zip(table["record"].tolist(), places, strict=True))

    def __len__(self) -> int:
        return len(self.labels)

    def __repr__(self) -> str:
        return f"Corpus({str(self.folder)!r})"

    def __getitem__(self, place: int) -> tuple[NDArray[np.float32], dict[str, Any]]:
        row = self.labels.iloc[index(place)].to_dict()
        return self.waveform(row["record"]), row

    def waveform(self, record: int, variable: str = "acceleration") -> NDArray[Any]:
        """One variable of the record with the global index `record`, exactly as it is stored: dtype, unit and shape are
        those of labels.variables, without the record dimension, so (T, axes) in m/s² for the acceleration.

        Raises BadInput if the record or the variable is not in the corpus.
        """
        shard, position = self._place(record)
        quick = quick_signal(self._root / shard, variable, int(record), position)
        if quick is not None:
            return quick
        with self._shards.reading(shard) as file:
            _require_at_its_place(file, record, position, shard)
            if not _is_of_records(file, variable):
                known = ", ".join(name for name in file.variables if _is_of_records(file, name))
                held = f"; dataset({record}) has it" if variable in file.variables else ""
                raise BadInput(
                    f"record {record} has no such signal{held}",
                    file=shard,
                    field="variable",
                    value=variable,
                    allowed=known,
                )
            return _values(file, variable, position)

    def signal(self, record: int, axis: str = "y") -> NDArray[np.float64]:
        """Acceleration (T,) of a record along one axis, float64, m/s²; BadInput if there is no such record or axis."""
        shard, position = self._place(record)
        axes = self.axes(record)
        if axis not in axes:
            raise BadInput(
                f"record {record} has no such axis", file=shard, field="axis", value=axis, allowed=", ".join(axes)
            )
        with self._shards.reading(shard) as file:
            _require_at_its_place(file, record, position, shard)
            found: NDArray[Any] = file.variables["acceleration"][position, :, axes.index(axis)]
        return found.astype(np.float64)

    def axes(self, record: int) -> list[str]:
        """Names of the axes along which the acceleration of a record is stored; BadInput if there is no such record."""
        shard, _ = self._place(record)
        with self._shards.reading(shard) as file:
            return [str(name) for name in _values(file, "axis", slice(None))]

    def has(self, record: int, variable: str) -> bool:
        """Whether that variable of a record is in the corpus; BadInput if there is no such record."""
        shard, _ = self._place(record)
        with self._shards.reading(shard) as file:
            return _is_of_records(file, variable)

    def _place(self, record: int) -> tuple[str, int]:
        if isinstance(record, bool | np.bool_) or not _is_whole(record):
            allowed = "a record index, such as those in labels[mask].record"
            raise BadInput(
                "not the index of a record", file=str(self.folder), field="record", value=record, allowed=allowed
            )
        try:
            return self._places[int(record)]
        except KeyError:
            first, last = min(self._places, default=0), max(self._places, default=0)
            allowed = f"{first} to {last}" if len(self._places) == last - first + 1 else "a record of its index.csv"
            raise BadInput(
                "not in this corpus", file=str(self.folder), field="record", value=int(record), allowed=allowed
            ) from None

    @property
    def open_files(self) -> list[Path]:
        """Paths of the shards kept open for this reader; a process keeps few open at a time, whoever reads them."""
        return self._shards.open_files

    def close(self) -> None:
        """Close the files kept open for speed; they open again when needed."""
        self._shards.close()

    def dataset(self, record: int) -> xarray.Dataset:
        """Everything stored of one record: signals, labels, scenario, its ball passes and its defects, as
        `xarray.open_dataset` gives them, without the record dimension. Raises BadInput if there is no such record."""
        import xarray
        from xarray.backends import NetCDF4DataStore

        shard, position = self._place(record)
        with self._shards.reading(shard) as file:
            _require_at_its_place(file, record, position, shard)
            opened = xarray.open_dataset(NetCDF4DataStore(file))
            tables = {"ball_pass": "pass_record", "defect": "defect_record"}
            rows_of_record = {
                table: np.flatnonzero(opened[column].values == record)
                for table, column in tables.items()
                if column in opened
            }
            found = opened.isel(rows_of_record | {"record": position}).load()
        found.set_close(None)  # the file is not the caller's to close
        return found

    def scenario(self, record: int) -> dict[str, Any]:
        """The scenario of one record: every number that is needed to simulate it again, SI units under `parameters`.

        Raises BadInput if there is no such record, or if it was recorded and not simulated.
        """
        found: dict[str, Any] = json.loads(str(self.waveform(record, "scenario")))
        return found

    def batches(
        self, size: int, variable: str = "acceleration", records: Iterable[int] | None = None
    ) -> Iterator[tuple[NDArray[np.int64], NDArray[Any]]]:
        """What `to_numpy` gives for `records` (all, in order, if None), in batches: pairs of record indices (B,) and
        their arrays (B, …) with B ≤ `size`.

        Only one batch is in memory at a time. Raises BadInput unless `size` is a whole number from 1 on, and on the way
        if the records of a batch differ in shape or one is not in the corpus.
        """
        if not isinstance(size, Integral) or size < 1:
            raise BadInput(field="size", value=size, allowed="a whole number from 1 on")
        chosen = np.asarray(list(self.labels["record"] if records is None else records))
        batches = (chosen[start : start + size] for start in range(0, chosen.size, size))
        return ((batch.astype(np.int64), self.to_numpy(variable, batch)) for batch in batches)

    def to_numpy(self, variable: str = "acceleration", records: Iterable[int] | None = None) -> NDArray[Any]:
        """What `waveform` gives for each of `records` (all, in order, if None), stacked to (N, …): (N, T, axes) in m/s²
        for the acceleration. Raises BadInput if they differ in shape, none is chosen, or one is not in the corpus."""
        chosen = list(self.labels["record"] if records is None else records)
        if not chosen:
            raise BadInput("no record was chosen", file=str(self.folder), field="variable", value=variable)
        first = self.waveform(chosen[0], variable)
        if first.dtype.kind == "U":  # as wide as the longest
            return np.stack([self.waveform(record, variable) for record in chosen])
        stacked = np.empty((len(chosen), *first.shape), first.dtype)  # filled in place: corpora nearly fill the memory
        for row, record in enumerate(chosen):
            signal = self.waveform(record, variable)
            if signal.shape != first.shape:
                raise BadInput(
                    f"the chosen records differ in shape ({chosen[0]}: {first.shape}, {record}: {signal.shape}); "
                    "choose records of one sampling rate, duration and bearing size",
                    file=str(self.folder), field="variable", value=variable,
                )  # fmt: skip
            stacked[row] = signal
        return stacked

    def folds(
        self, count: int = 5, stratify: str = "condition", seed: int = 0
    ) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
        """`count` pairs of record indices to train on (M,) and to test on (N,), for cross-validation without leakage.

        All records of a virtual bearing (`bearing_id`) are on the same side, and each side has about the same share of
        every value of the label `stratify`. Raises BadInput if there are fewer bearings, or fewer records of every
        value, than folds, for a label that is unknown or of numbers with decimals, and for a `seed` that is no whole
        number from 0 to 2³² − 1.
        """
        from sklearn.model_selection import StratifiedGroupKFold

        self._require_folds(count, stratify)
        if not (isinstance(seed, int | np.integer) and 0 <= seed <= LARGEST_SEED):
            raise BadInput(field="seed", value=seed, allowed=f"a whole number from 0 to {LARGEST_SEED}")
        table = self.labels
        record = table["record"].to_numpy()
        parted = StratifiedGroupKFold(count, shuffle=True, random_state=seed)
        with warnings.catch_warnings():
            # What it warns of, fewer records of some value than folds, is no fault of the caller.
            warnings.filterwarnings("ignore", "The least populated class", UserWarning)
            folds = list(parted.split(record, _as_words(table[stratify]), groups=table["bearing_id"]))
        return ((record[train], record[test]) for train, test in folds)

    def _require_folds(self, count: int, stratify: str) -> None:
        """Raise BadInput unless the records can be parted into `count` folds, alike in that label."""
        table = self.labels
        known = [name for name in table if table[name].dtype.kind != "f"]
        if stratify not in table or _has_decimals(table[stratify]):
            problem = "no such label" if stratify not in table else "this label takes other values with every record"
            raise BadInput(problem, file=str(self.folder), field="stratify", value=stratify, allowed=", ".join(known))
        bearings = table["bearing_id"].nunique()
        most = min(bearings, max(Counter(_as_words(table[stratify])).values(), default=0))
        if isinstance(count, int | np.integer) and 2 <= count <= most:
            return
        limit = f"of no {stratify} are there more than {most} records" if most < bearings else "each fold tests its own"
        allowed = f"a whole number from 2 to {most}" if most > 1 else "none"
        bearings_text = f"its records are of {bearings} bearings" if bearings != 1 else "its records are of one bearing"
        if (table["bearing_id"] == UNKNOWN).all():
            bearings_text = "the bearing_id of its records is unknown, so that they count as one bearing"
        raise BadInput(
            f"{bearings_text}, and {limit}", file=str(self.folder), field="count", value=count, allowed=allowed
        )


def _as_words(column: pandas.Series) -> list[str]:
    """The values of a label; what is unknown is a word like any other (of NaN pandas makes none)."""
    return list(map(str, column))


def _has_decimals(column: pandas.Series) -> bool:
    return column.dtype.kind == "f" and bool((column.dropna() % 1.0 != 0.0).any())


def _is_of_records(file: netCDF4.Dataset, variable: str) -> bool:
    """Whether an open shard has that variable, with a value for each of its records."""
    return variable in file.variables and file.variables[variable].dimensions[:1] == ("record",)


def _values(file: netCDF4.Dataset, variable: str, place: int | slice) -> NDArray[Any]:
    """What an open shard holds at a `place` of a variable; a single text is a `str`."""
    held = file.variables[variable]
    held.set_auto_chartostring(True)  # xarray turns that off in a file that it has read
    found: NDArray[Any] = held[place]
    return found[()] if found.dtype.kind == "U" else found


def _require_at_its_place(file: netCDF4.Dataset, record: int, position: int, shard: str) -> None:
    """Raise BadInput unless the shard holds that record there: a run since the labels were read may have moved it."""
    held = file.variables["record"]
    if position < held.shape[0] and int(held[position]) != int(record):
        raise BadInput(
            "the corpus has changed since its labels were read; open it again",
            file=shard,
            field="record",
            value=int(record),
        )


def _is_whole(record: object) -> bool:
    try:
        return record == int(record)  # type: ignore[call-overload]
    except (TypeError, ValueError, OverflowError):
        return False

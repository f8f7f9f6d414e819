"""Checking one shard: its bytes, its arrays, its labels, and that the recipe still gives its scenarios."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from datagen.corpus_files.format import content_hash
from datagen.corpus_files.manifest import shard_entry
from datagen.corpus_files.reading import READ_ERRORS, unencodable
from datagen.corpus_files.shard import LABEL_COLUMNS, Sidecar, label_columns, shard_path
from datagen.files.digest import file_hash
from datagen.files.netcdf import ONE_AT_A_TIME
from datagen.inspection.conformity import violations
from datagen.inspection.corpus_parts import CorpusParts
from datagen.inspection.findings import Findings, of_file
from datagen.versions import program_hash

if TYPE_CHECKING:
    import xarray

FORBIDDEN = "it cannot be read for lack of permission; change its permissions"


def check_shard(parts: CorpusParts, sidecar: Sidecar) -> Findings:
    """Everything wrong with the shard that `sidecar` vouches for, which holds records."""
    entry = shard_entry(sidecar)
    dataset, damage = _opened(shard_path(parts.folder, sidecar.shard), sidecar)
    found = of_file(entry.file, damage, damaged=bool(damage) and damage != [FORBIDDEN])
    if sidecar.identity != parts.manifest.identity:
        found += of_file(entry.file, ["made from another recipe, physics or format than the manifest states"])
    if dataset is not None:
        found += of_file(entry.file, _wrong_content(parts, sidecar, dataset))
        if _index_disagrees(parts, sidecar, entry.file):
            found += of_file(entry.file, ["index.csv disagrees about its records"], unfinished=True)
        found += of_file(entry.file, _wrong_scenarios(parts, dataset))
    if entry not in parts.manifest.shards and entry.file not in parts.unlisted:
        found += of_file(entry.file, ["manifest.json and its sidecar disagree about it"])
    return found


def _opened(path: Path, sidecar: Sidecar) -> tuple[xarray.Dataset | None, list[str]]:
    """What a shard's file holds, None if it cannot be read, and in what it differs from what was written."""
    import xarray

    if not path.is_file():
        return None, ["missing"]
    found = []
    try:
        if file_hash(path) != sidecar.sha256:
            found.append("its bytes have changed since it was written (SHA-256 differs)")
        with ONE_AT_A_TIME, xarray.open_dataset(path, engine="netcdf4") as opened:
            dataset = opened.load()
        if content_hash(dataset) != sidecar.content:
            found.append("its arrays are not those originally written")
    except UnicodeEncodeError:
        raise unencodable(path) from None
    except PermissionError:
        return None, [FORBIDDEN]
    except READ_ERRORS as problem:
        return None, [*found, f"cannot be read: {problem}"]
    return dataset, found


def _wrong_content(parts: CorpusParts, sidecar: Sidecar, dataset: xarray.Dataset) -> Iterator[str]:
    from datagen.runs.plan import signals_of_every_record

    yield from violations(dataset)
    for name in signals_of_every_record(parts.recipe) if parts.recipe else ():
        if name not in dataset:
            yield f"{name} is missing, but the recipe asks for it"
    if label_columns(dataset) != sidecar.labels:
        yield "its labels are not those of its sidecar"


def _index_disagrees(parts: CorpusParts, sidecar: Sidecar, name: str) -> bool:
    """Whether the index says something else of the records of the shard whose file is called `name`.

    A shard that neither index nor manifest knows is no disagreement: both are written at the end of a run.
    """
    if parts.index is None or (name in parts.unlisted and name not in parts.rows_of_shard):
        return False
    rows = parts.index.iloc[parts.rows_of_shard.get(name, [])].sort_values("position")
    stated = {c: [None if value != value else value for value in rows[c].tolist()] for c in LABEL_COLUMNS}
    return stated != sidecar.labels or rows["position"].tolist() != list(range(len(sidecar.records)))


def _wrong_scenarios(parts: CorpusParts, dataset: xarray.Dataset) -> Iterator[str]:
    from datagen.scenarios.sampling import draw_scenario
    from datagen.scenarios.scenario_text import scenario_json

    recipe = parts.recipe
    if recipe is None or not recipe.drawable or parts.manifest.identity.program_hash != program_hash():
        return
    for record, text in zip(dataset["record"].values.tolist(), dataset["scenario"].values, strict=True):
        if scenario_json(draw_scenario(recipe, record)) != str(text):
            yield f"the recipe gives record {record} another scenario than the stored one"
            return

"""What a manifest adds up."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest

from datagen.corpus_files.format import Identity
from datagen.corpus_files.manifest import Manifest, ShardEntry, Span, add_spans
from datagen.corpus_files.shard import Failure, Sidecar
from datagen.scenarios.refused import Refused

IDENTITY = Identity("r" * 16, "m" * 16, "f" * 16, "p" * 16)


def test_a_manifest_counts_what_a_shard_without_a_record_cost_and_why(tmp_path: Path) -> None:
    refused = {"record: extent": Refused(2, "too long")}
    sidecar = Sidecar(0, IDENTITY, failed=(Failure(7, "no equilibrium"),), seconds=1.5, refused=refused)
    manifest = Manifest("a", IDENTITY, {}, 8, ((7, 8),)).with_shards([sidecar])
    assert (manifest.shards, manifest.failed, manifest.seconds) == ((), sidecar.failed, 1.5)
    assert manifest.refused == refused


def test_a_manifest_lists_the_shards_that_hold_records_and_adds_them_up(tmp_path: Path) -> None:
    refused = Refused(2, "too long")
    sidecars = [
        Sidecar(3, IDENTITY, (4, 6, 9), bytes=70, sha256="s", content="c", seconds=0.25, refused={"record": refused}),
        Sidecar(4, IDENTITY, failed=(Failure(5, "why"),), seconds=0.5, refused={"record": refused}),
        Sidecar(5, IDENTITY, (7,), bytes=30, sha256="t", content="d", seconds=1.0),
    ]
    begun = Manifest("a", IDENTITY, {"title": "A title"}, 12, ((0, 3), (4, 10)), bytes=5, seconds=9.0)
    manifest = begun.with_shards(sidecars)
    assert manifest.shards == (
        ShardEntry("shards/shard_000003.nc", 3, 4, 9, 70, "s", "c"),
        ShardEntry("shards/shard_000005.nc", 1, 7, 7, 30, "t", "d"),
    )
    assert (manifest.records, manifest.asked_records, manifest.bytes, manifest.seconds) == (4, 9, 100, 1.75)
    assert manifest.refused == {"record": Refused(4, "too long")}
    assert (manifest.imported, manifest.title) == (False, "A title")


@pytest.mark.parametrize(
    "spans", [((0, 10), (2, 4)), ((5, 6), (0, 5)), ((0, 3), (3, 4), (8, 9)), ((2, 4), (0, 10), (9, 12))]
)
def test_spans_that_are_added_up_hold_each_record_of_any_of_them_once(spans: tuple[Span, ...]) -> None:
    merged = add_spans(spans[:1], spans[1:])
    assert [record for span in merged for record in range(*span)] == sorted({k for span in spans for k in range(*span)})
    assert all(before[1] < after[0] for before, after in pairwise(merged))

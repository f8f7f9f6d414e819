"""What a manifest adds up."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest

from datagen.corpus_files.format import Identity
from datagen.corpus_files.manifest import Manifest, Span, add_spans
from datagen.corpus_files.shard import Failure, Sidecar
from datagen.scenarios.redraw import Refused

IDENTITY = Identity("r" * 16, "m" * 16, "f" * 16, "p" * 16)


def test_a_manifest_counts_what_a_shard_without_a_record_cost_and_why(tmp_path: Path) -> None:
    refused = {"record: extent": Refused(2, "too long")}
    sidecar = Sidecar(0, IDENTITY, failed=(Failure(7, "no equilibrium"),), seconds=1.5, refused=refused)
    manifest = Manifest("a", IDENTITY, {}, 8, ((7, 8),)).with_shards(tmp_path, [sidecar])
    assert (manifest.shards, manifest.failed, manifest.seconds) == ((), sidecar.failed, 1.5)
    assert manifest.refused == refused


@pytest.mark.parametrize(
    "spans", [((0, 10), (2, 4)), ((5, 6), (0, 5)), ((0, 3), (3, 4), (8, 9)), ((2, 4), (0, 10), (9, 12))]
)
def test_spans_that_are_added_up_hold_each_record_of_any_of_them_once(spans: tuple[Span, ...]) -> None:
    merged = add_spans(spans[:1], spans[1:])
    assert [record for span in merged for record in range(*span)] == sorted({k for span in spans for k in range(*span)})
    assert all(before[1] < after[0] for before, after in pairwise(merged))

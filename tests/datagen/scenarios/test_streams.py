"""Random streams: reproducible, independent of order, and never changed by what is added later."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from datagen.scenarios.streams import PURPOSES, SCOPES, stream


def test_the_same_key_gives_the_same_numbers_whatever_was_drawn_before() -> None:
    first = stream(7, "record", 3, "slip").random(5)
    stream(7, "record", 4, "slip").random(100)
    np.testing.assert_array_equal(stream(7, "record", 3, "slip").random(5), first)


def test_every_part_of_the_key_opens_another_stream() -> None:
    keys = [
        (seed, scope, index, purpose, attempt, item)
        for seed, scope, index, purpose, attempt, item in product((0, 1), SCOPES, (0, 1), PURPOSES, (0, 1), (0, 1))
    ]
    assert len({float(stream(*key).random()) for key in keys}) == len(keys)


def test_the_stream_is_the_documented_seed_sequence() -> None:
    expected = np.random.default_rng(np.random.SeedSequence(99, spawn_key=(1, 12, 3, 2, 1))).random(3)
    np.testing.assert_array_equal(stream(99, "machine", 12, "background", 2, 1).random(3), expected)


def test_scopes_and_purposes_only_ever_grow_at_their_end() -> None:
    assert SCOPES[:3] == ("record", "machine", "part")
    assert PURPOSES[:25] == (
        "machine",
        "signal",
        "imperfections",
        "background",
        "split",
        "operation",
        "defect",
        "spall",
        "slip",
        "roughness",
        "white_noise",
        "chain",
        "sensor_modes",
        "pink_noise",
        "shaft_harmonics",
        "gear_mesh",
        "mains_hum",
        "impulses",
        "recording",
        "noise_target",
        "design",
        "balance_machines",
        "balance_records",
        "stated_speed",
        "bootstrap",
    )


@pytest.mark.parametrize(
    "arguments", [("records", 0, "slip"), ("record", 0, "slipp"), ("record", -1, "slip"), ("record", 2**32, "slip")]
)
def test_an_unknown_scope_or_purpose_or_index_is_refused(arguments: tuple[str, int, str]) -> None:
    with pytest.raises(ValueError):  # noqa: PT011  (tuple.index has its own wording)
        stream(99, *arguments)

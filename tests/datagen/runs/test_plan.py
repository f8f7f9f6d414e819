from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest

from datagen.errors import BadInput
from datagen.recipes.recipe import Recipe, load_recipe
from datagen.records.profile_grid import PROFILE_POINTS
from datagen.records.stiffness_axis import stiffness_axis
from datagen.runs.plan import PlannedShard, longest_first, needed_bytes, plan_shards, selection, stored_bytes
from datagen.scenarios.sampling import draw_scenario


def test_every_record_is_planned_once_and_shards_are_filled_in_order(tiny: Recipe) -> None:
    planned = plan_shards(tiny, tiny.count)
    assert sorted(record for shard in planned for record in shard.records) == list(range(14))
    assert [shard.number for shard in planned] == list(range(len(planned)))
    assert all(1 <= len(shard.records) <= 2 for shard in planned)
    assert [shard.records[0] for shard in planned] == sorted(shard.records[0] for shard in planned)


def test_a_longer_plan_continues_a_shorter_one(tiny: Recipe) -> None:
    whole = plan_shards(tiny, tiny.count)
    for stop in range(1, tiny.count):
        part = plan_shards(tiny, stop)
        for shard in part:
            assert shard.records == tuple(record for record in whole[shard.number].records if record < stop)


def test_records_of_different_rigs_or_stored_signals_never_share_a_shard(tiny: Recipe) -> None:
    for shard in plan_shards(tiny, tiny.count):
        assert len({record < 8 for record in shard.records}) == 1
    forces = [shard.records for shard in plan_shards(tiny, tiny.count) if "contact_force" in shard.stored]
    assert sum(map(len, forces)) == 4  # gearbox healthy, line, extended; fan line


def test_forces_are_kept_of_the_first_of_a_rig_and_condition_whatever_its_part(
    tiny_recipe: Path, tmp_path: Path
) -> None:
    (tmp_path / "a.toml").write_text(tiny_recipe.read_text().replace('machine.rig = "fan"', 'machine.rig = "gearbox"'))
    recipe = load_recipe(tmp_path / "a.toml")
    conditions = [draw_scenario(recipe, record).condition for record in range(recipe.count)]
    assert set(conditions[:8]) == {"healthy", "line", "extended"}  # so that the second part, on the same rig, adds none
    planned = plan_shards(recipe, recipe.count)
    kept = [record for shard in planned if "contact_force" in shard.stored for record in shard.records]
    assert sorted(kept) == sorted(map(conditions.index, ("healthy", "line", "extended")))


def test_the_size_of_a_record_counts_every_stored_signal(tiny: Recipe) -> None:
    samples, rows, balls = 1638, 2, 12  # 0.05 s at 32 768 Hz on the gearbox rig
    scenario = next(one for one in (draw_scenario(tiny, record) for record in range(8)) if one.condition == "line")
    always = samples * (2 * 4 + 4) + stiffness_axis(scenario).size * 3 * 4  # acceleration, envelope, stiffness
    assert stored_bytes(scenario, (), "none") == always
    everything = ("acceleration_clean", "cage_angle", "profile_depth", "contact_force")
    optional = samples * (2 * 4 + 8 + rows * balls * 4) + rows * PROFILE_POINTS * 4
    assert stored_bytes(scenario, everything, "none") == always + optional
    assert 0.3 * always < stored_bytes(scenario, (), "zlib") < always


def test_the_long_axes_of_a_shard_take_eight_bytes_a_node(tiny: Recipe) -> None:
    plain = tiny.model_copy(update={"store": tiny.store.model_copy(update={"compression": "none"})})
    scenario = draw_scenario(plain, 0)
    time = np.arange(scenario.samples) / scenario.rate
    profile = np.zeros(PROFILE_POINTS if "profile_depth" in plan_shards(plain, 1)[0].stored else 0)
    expected = time.nbytes + stiffness_axis(scenario).nbytes + profile.nbytes
    assert plan_shards(plain, 1)[0].axis_bytes == expected
    # Even steps are deflated to a tenth of that.
    assert plan_shards(tiny, 1)[0].axis_bytes == pytest.approx(0.1 * expected)


def test_the_size_said_beforehand_is_near_that_of_the_corpus(tiny: Recipe, tiny_corpus: Path) -> None:
    said = needed_bytes(plan_shards(tiny, tiny.count))
    assert 0.7 < said / sum(path.stat().st_size for path in (tiny_corpus / "shards").glob("*.nc")) < 1.4


def test_a_selection_is_everything_a_prefix_or_a_list(tiny: Recipe) -> None:
    assert selection(tiny, None, None) == ((0, 14),)
    assert selection(tiny, 5, None) == ((0, 5),)
    assert selection(tiny, 99, None) == ((0, 14),)
    assert selection(tiny, None, [9, 3, 4, 9]) == ((3, 5), (9, 10))


def test_records_may_be_listed_in_numpys_numbers(tiny: Recipe) -> None:
    spans = selection(tiny, None, np.array([7, 2, 3]))
    assert json.dumps(spans) == "[[2, 4], [7, 8]]"  # as the manifest keeps them


def test_a_limit_may_be_one_of_numpys_numbers(tiny: Recipe) -> None:
    assert json.dumps(selection(tiny, np.int64(3), None)) == "[[0, 3]]"  # as the manifest keeps them


@pytest.mark.parametrize("kind", [list, np.array])
def test_a_mask_is_no_list_of_records(kind: Callable[[list[bool]], Sequence[int]], tiny: Recipe) -> None:
    with pytest.raises(BadInput, match="--records: this is a mask; allowed: the indices of records"):
        selection(tiny, None, kind([True, False, True]))


def test_an_empty_list_of_records_is_refused(tiny: Recipe) -> None:
    with pytest.raises(BadInput, match="--records"):
        selection(tiny, None, [])


def test_shards_that_take_longest_are_handed_out_first(tiny: Recipe) -> None:
    lengths = {0: (4, 0.5), 1: (1, 3.0), 2: (32, 1.0), 3: (5, 0.1)}
    shards = [
        PlannedShard(number, (0,) * count, (), 1.0, 1.0, 0.0, seconds) for number, (count, seconds) in lengths.items()
    ]
    assert [shard.number for shard in longest_first(shards)] == [2, 1, 0, 3]


def test_a_plan_that_takes_long_tells_how_far_it_has_got(tiny: Recipe, monkeypatch: pytest.MonkeyPatch) -> None:
    said: list[str] = []
    plan_shards(tiny, 3, said.append)
    assert said == []
    monkeypatch.setattr("datagen.runs.plan.SECONDS_BETWEEN_REPORTS", 0.0)
    plan_shards(tiny, 3, said.append)
    assert said == [f"{record} of 3 records are drawn; none is made before all are" for record in range(3)]


def test_a_record_takes_in_memory_what_it_takes_without_compression(tiny: Recipe) -> None:
    for shard in plan_shards(tiny, tiny.count):
        scenario = draw_scenario(tiny, shard.records[0])
        assert shard.raw_bytes == stored_bytes(scenario, shard.stored, "none")
        assert shard.record_bytes == stored_bytes(scenario, shard.stored, tiny.store.compression)

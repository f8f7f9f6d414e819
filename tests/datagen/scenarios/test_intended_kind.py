"""A redraw keeps what was meant: what is often impossible of one condition or race does not turn into another."""

from __future__ import annotations

import json
from collections import Counter
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from datagen.errors import BadInput
from datagen.recipes.recipe import parse_recipe
from datagen.scenarios.intended_kind import IntendedKind
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario import Scenario

RECORDS = 120
GEARBOX = {"rig": "gearbox"}  # balls 30 degrees apart
EASY = {
    "condition": {"choice": ["healthy", "line", "extended"]},
    "race": {"choice": ["outer", "inner"]},
    "depth_um": 10,
    "line": {"extent_deg": 2},
    "extended": {"extent_deg": 40},
}
# What is often impossible, and of which condition or race the more so.
OFTEN_IMPOSSIBLE: dict[str, dict[str, Any]] = {
    "tapers longer than a line spall": {"entry_taper_deg": {"uniform": [1, 20]}},
    "two long spalls on one race": {
        "count": 2,
        "separation_deg": {"uniform": [10, 180]},
        "extended": {"extent_deg": 90},
    },
    "line spalls mostly as long as the spacing": {"line": {"extent_deg": {"uniform": [25, 50]}}},
    "extended spalls mostly shorter than the spacing": {"extended": {"extent_deg": {"uniform": [10, 35]}}},
    "lengths that are rarely below the spacing of the inner race": {
        "condition": {"choice": ["healthy", "line"]},
        "line": {"extent_mm": {"uniform": [8, 11]}},
    },
}


def recipe_of(defect: dict[str, Any], machine: dict[str, Any] = GEARBOX, **settings: Any) -> str:
    """A recipe of one part with these defects, as JSON."""
    part = {"name": "p", "records": RECORDS, "machine": machine, "defect": defect} | settings
    signal = {"rate_hz": 65536, "duration_s": 0.05}
    return json.dumps({"name": "r", "seed": 8, "signal": signal, "part": [part]})


@cache
def scenarios(recipe: str) -> list[Scenario]:
    """The scenarios of all records of a recipe, which is given as JSON."""
    parsed = parse_recipe(json.loads(recipe), Path("recipe.toml"))
    return [draw_scenario(parsed, record) for record in range(parsed.count)]


def states(recipe: str) -> list[tuple[str, str]]:
    """Condition and race of every record."""
    return [(scenario.condition, scenario.location) for scenario in scenarios(recipe)]


@pytest.mark.parametrize("impossible", OFTEN_IMPOSSIBLE)
@pytest.mark.parametrize(
    ("drawn_for", "design"),
    [
        ("record", "random"),
        ("machine", "sobol"),
        pytest.param("machine", "random", marks=pytest.mark.slow),
        pytest.param("record", "sobol", marks=pytest.mark.slow),
    ],
)
def test_every_record_has_the_condition_and_race_that_it_has_where_all_is_possible(
    impossible: str, drawn_for: str, design: str
) -> None:
    defect = EASY | OFTEN_IMPOSSIBLE[impossible] | {"drawn_for": drawn_for}
    easy = EASY | {"condition": defect["condition"], "drawn_for": drawn_for}
    hard = recipe_of(defect, design=design)
    assert states(hard) == states(recipe_of(easy, design=design))
    assert sum(bool(scenario.redraws) for scenario in scenarios(hard)) > RECORDS / 12


def test_records_of_a_machine_whose_spall_was_drawn_again_share_its_kind() -> None:
    defect = EASY | {"line": {"extent_deg": {"uniform": [25, 50]}}, "drawn_for": "machine"}
    found = states(recipe_of(defect, records_per_machine=3))
    assert all(len(set(found[first : first + 3])) == 1 for first in range(0, RECORDS, 3))
    assert found == states(recipe_of(EASY | {"drawn_for": "machine"}, records_per_machine=3))


def test_what_no_kind_of_spall_could_have_leaves_the_next_draw_free_but_for_healthy() -> None:
    # Nine of ten pairs of tapers are longer than their spall, whichever it is; line and extended are as likely.
    hard = recipe_of(EASY | {"entry_taper_share": {"uniform": [0.55, 1]}, "exit_taper_share": 0.4})
    easy, found = states(recipe_of(EASY)), states(hard)
    assert [state == ("healthy", "none") for state in found] == [state == ("healthy", "none") for state in easy]
    moved = Counter(one[0] for one, other in zip(easy, found, strict=True) if one != other)
    assert min(moved["line"], moved["extended"]) > 10


@pytest.mark.parametrize(
    ("machine", "defect", "words"),
    [
        (
            {"rig": {"choice": ["gearbox", "cwru"]}},  # 12 and 9 balls
            EASY | {"line": {"extent_deg": {"uniform": [31, 39]}}},
            'recipe.toml: part[1].defect.line.extent_deg = {uniform = [31.0, 39.0]}: record 10 of part "p", meant to '
            "be line (outer race, profile tukey): 200 draws in a row were impossible (refused: extent 200 times); "
            "the last: condition = line, but the spall of",
        ),
        (
            {"rig": {"choice": ["gearbox", "cwru"]}},
            EASY | {"extended": {"extent_deg": 35}},
            "defect.extended.extent_deg = 35.0: record",
        ),
        (
            GEARBOX,
            EASY | {"entry_taper_deg": 3, "line": {"extent_spacing": 0.05}},
            "defect.entry_taper_deg = 3.0: record",
        ),
        (GEARBOX, EASY | {"count": 4, "extended": {"extent_deg": 95}}, "defect.count = 4: record"),
        (
            {"rig": "cwru", "rows": {"choice": [1, 2], "weights": [1, 1e-9]}},
            EASY | {"outer": {"row": 1}, "inner": {"row": 2}},
            "defect.inner.row = 2: record",
        ),
        (GEARBOX, EASY | {"inner": {"extent_mm": 200}}, "defect.inner.extent_mm = 200.0: record"),
    ],
)
def test_a_condition_or_race_that_can_never_be_is_refused_by_the_setting_that_holds_for_it(
    machine: dict[str, Any], defect: dict[str, Any], words: str
) -> None:
    with pytest.raises(BadInput) as refused:
        states(recipe_of(defect, machine))
    assert words in str(refused.value)


def test_a_kind_binds_from_the_first_refusal_on_that_another_might_have_been_spared() -> None:
    line, extended, healthy = (
        ("line", "outer", "tukey"),
        ("extended", "outer", "tukey"),
        ("healthy", "outer", "tukey"),
    )
    intended = IntendedKind()
    assert intended.kind is None
    assert intended.settle(line) == line
    intended.release()
    assert intended.settle(healthy) == line
    intended.release()
    assert intended.settle(extended) == extended
    assert intended.settle(line) == extended
    intended.release()  # one refusal for all kinds does not undo an earlier one that was of this kind alone
    assert intended.settle(line) == intended.kind == extended
    assert IntendedKind(line).settle(extended) == line

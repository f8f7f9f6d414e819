"""Settings that can never go together are refused when a recipe is read, by name, even where other draws could be."""

from pathlib import Path
from typing import Any

import pytest

from datagen.errors import BadInput
from datagen.recipes.recipe import Recipe, parse_recipe

GEARBOX = {"rig": "gearbox"}  # two rows of 12 balls
CWRU = {"rig": "cwru"}  # one row of 9 balls
LINE = {"condition": "line", "extent_deg": 2, "depth_um": 9}


def recipe_of(machine: dict[str, Any], defect: dict[str, Any]) -> Recipe:
    """A recipe of one part of that machine and defect."""
    part = {"name": "p", "records": 4, "machine": machine, "defect": defect}
    content = {"name": "r", "seed": 5, "signal": {"rate_hz": 65536, "duration_s": 0.1}, "part": [part]}
    return parse_recipe(content, Path("recipe.toml"))


@pytest.mark.parametrize(
    ("machine", "defect", "message"),
    [
        (CWRU, LINE | {"row": 2}, "part[1].defect.row = 2: no bearing of this part has a second row; allowed: 1, any"),
        (GEARBOX | {"rows": 1}, LINE | {"row": "both"}, 'part[1].defect.row = "both": no bearing of this part has'),
        (
            CWRU,
            LINE | {"condition": {"choice": ["healthy", "line"]}, "line": {"row": {"choice": [2, "both"]}}},
            'part[1].defect.line.row = {choice = [2, "both"]}: no bearing of this part has a second row',
        ),
        (
            GEARBOX,
            LINE | {"count": 2, "separation_deg": 0},
            "part[1].defect.separation_deg = 0: line spall, outer race, profile tukey: spalls 1 and 2 of 2 overlap, as "
            "their centres are 0 degrees apart; allowed: such that the centres of all are at least 2 degrees apart",
        ),
        (GEARBOX, LINE | {"count": 2, "separation_deg": -358.5}, "as their centres are 1.5 degrees apart"),
        (GEARBOX, LINE | {"count": {"choice": [5, 6]}, "separation_deg": 90}, "spalls 1 and 5 of 5 overlap"),
        (
            GEARBOX,
            {"condition": "line", "extent_mm": 1, "depth_um": 9, "outer": {"count": 2, "separation_deg": 360}},
            "part[1].defect.outer.separation_deg = 360",
        ),
        (
            GEARBOX,
            {"condition": "line", "extent_spacing": {"uniform": [1, 2]}, "depth_um": 9},
            "part[1].defect.extent_spacing = {uniform = [1, 2]}: line spall, outer race, profile tukey: 1 is no line "
            "spall; allowed: below 1 ball spacing",
        ),
        (
            GEARBOX,
            LINE | {"condition": {"choice": ["line", "extended"]}, "extended": {"extent_spacing": 0.9}},
            "part[1].defect.extended.extent_spacing = 0.9: extended spall, outer race, profile tukey: 0.9 is no "
            "extended spall; allowed: at least 1 ball spacing",
        ),
        (GEARBOX, LINE | {"extent_deg": 30}, "part[1].defect.extent_deg = 30: a line spall is shorter than the ball"),
        (
            CWRU,
            LINE | {"condition": "extended", "extent_deg": 39.9},
            "at least as long as the ball spacing; allowed: 4",
        ),
        (
            GEARBOX | {"balls": {"choice": [6, 8]}},
            LINE | {"condition": "extended", "extent_deg": {"uniform": [1, 44]}},
            "allowed: 45 or more",
        ),
        (
            GEARBOX,
            LINE | {"inner": {"entry_taper_deg": 3}, "race": "inner"},
            "part[1].defect.inner.entry_taper_deg = 3: 3 is longer than the spall, extent_deg = 2; allowed: 0 to 2",
        ),
        (GEARBOX, LINE | {"row": "1"}, 'part[1].defect.row = "1"; allowed: 1, 2, both, any; did you mean 1, without q'),
        (
            GEARBOX | {"separate_cages": "True"},
            LINE,
            'separate_cages = "True"; allowed: false, true; did you mean true, without quotes?',
        ),
        (GEARBOX, LINE | {"row": "bot"}, 'allowed: 1, 2, both, any; did you mean "both"?'),
    ],
)
def test_what_can_never_go_together_is_refused_by_name(
    machine: dict[str, Any], defect: dict[str, Any], message: str
) -> None:
    with pytest.raises(BadInput) as refused:
        recipe_of(machine, defect)
    assert message in str(refused.value)


@pytest.mark.parametrize(
    ("machine", "defect"),
    [
        (GEARBOX, LINE | {"row": 2}),
        (CWRU, LINE | {"row": {"choice": [1, 2]}}),
        (CWRU, LINE | {"row": "any"}),
        ({"rig": {"choice": ["cwru", "gearbox"]}}, LINE | {"row": 2}),
        (CWRU | {"rows": 2}, LINE | {"row": 2}),
        (GEARBOX, LINE | {"count": 2, "separation_deg": 2}),  # they touch
        (GEARBOX, LINE | {"count": 4, "separation_deg": 90}),
        (GEARBOX, LINE | {"count": {"choice": [1, 2]}, "separation_deg": 0}),
        (GEARBOX, LINE | {"separation_deg": 0}),
        (GEARBOX, {"condition": "line", "extent_spacing": {"uniform": [0.9, 2]}, "depth_um": 9}),
        (GEARBOX, LINE | {"condition": "extended", "extent_deg": 30}),
        ({"rig": {"choice": ["cwru", "gearbox"]}}, LINE | {"condition": "extended", "extent_deg": 30}),
        (GEARBOX | {"fill": 0.5}, LINE | {"extent_deg": 50}),
    ],
)
def test_what_may_be_drawn_is_let_through(machine: dict[str, Any], defect: dict[str, Any]) -> None:
    assert recipe_of(machine, defect).count == 4

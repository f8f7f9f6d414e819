"""The drawing of stability maps."""

import math

from datagen.charts import stability
from datagen.drawing.stability_map import draw_sheet, kind, kinds, stability_sheets
from datagen.drawing.style import house_style

PNG = b"\x89PNG\r\n"


def made_map(sweep):
    """A map of two values: at the first all is accurate, at the second steps end by an outcome or are refused."""
    return stability.Map(
        method="m",
        scale=stability.BY_STEP,
        rows=stability.STEPS,
        sweep=sweep,
        unit="u",
        values=(1.0, 3e4),
        error=((0.0,) * 8, (math.nan,) * 8),
        outcomes=((stability.VALUE,) * 8, ("not finite",) * 8),
        refused=((False,) * 8, (True,) * 2 + (False,) * 6),
        limit=(math.inf, 2.0),
    )


def test_the_kinds_of_a_map_follow_refusal_outcome_and_size_of_the_error():
    value, failed = stability.VALUE, (math.nan, "not finite")
    assert [kind(error, value, False) for error in (5e-4, 5e-3, 5e-2, 0.5)] == [0, 1, 2, 3]
    assert [kind(*failed, False), kind(*failed, True), kind(5e-4, value, True)] == [4, 6, 6]
    assert kind(math.nan, stability.NOT_CONVERGED, True) == 5
    assert kinds(made_map("s")) == [[0, 6]] * 2 + [[0, 4]] * 6


def test_a_sheet_of_maps_holds_four_quantities():
    assert [sheet[:6] for sheet in stability_sheets([made_map(name) for name in "abcde"])] == [PNG] * 2
    with house_style():
        figure = draw_sheet([made_map(name) for name in "abcd"], "1 of 2")
        figure.draw_without_rendering()
        named = [panel.texts[0].get_text() for panel in figure.axes]
        hatched = [sum(patch.get_hatch() is not None for patch in panel.patches) for panel in figure.axes]
    assert named == list("abcd")
    assert hatched == [2] * 4

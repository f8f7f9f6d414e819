"""The drawing of stability maps."""

import dataclasses
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


def panels_of(*maps):
    """The panels of a sheet of maps."""
    with house_style():
        figure = draw_sheet(maps, "1 of 1")
        figure.draw_without_rendering()
    return figure.axes


def test_the_kinds_of_a_map_follow_refusal_outcome_and_size_of_the_error():
    value, failed = stability.VALUE, (math.nan, "not finite")
    assert [kind(error, value, False) for error in (5e-4, 5e-3, 5e-2, 0.5)] == [0, 1, 2, 3]
    assert [kind(*failed, False), kind(*failed, True), kind(5e-4, value, True)] == [4, 6, 6]
    assert kind(math.nan, stability.NOT_CONVERGED, True) == 5
    assert kinds(made_map("s")) == [[0, 6]] * 2 + [[0, 4]] * 6


def test_the_longest_stable_step_is_drawn_among_the_rows_of_steps():
    (panel,) = panels_of(made_map("s"))
    (line,) = panel.lines
    # On the row of its 2 samples a step; above all rows where there is no limit.
    assert line.get_xydata()[1].tolist() == [1.0, stability.STEPS.index(2.0)]
    assert line.get_ydata()[0] < -0.5 == panel.get_ylim()[1]
    (unlimited,) = panels_of(dataclasses.replace(made_map("s"), limit=(math.inf, math.inf)))
    assert not unlimited.lines


def test_rows_and_columns_of_a_map_are_named_as_shortly_as_can_be():
    (panel,) = panels_of(dataclasses.replace(made_map("s"), values=(0.5, 3e4)))
    assert [label.get_text() for label in panel.get_yticklabels()] == ["8", "2", "1/2", "1/8"]
    assert [label.get_text() for label in panel.get_xticklabels()] == ["0.5", "$3·10^{4}$"]
    exact = dataclasses.replace(
        made_map("s"), scale=stability.BY_ACCURACY, rows=stability.ACCURACIES, values=(1.0, 1e3)
    )
    (panel,) = panels_of(exact)
    assert [label.get_text() for label in panel.get_yticklabels()] == ["0.1", "0.01", "0.001", "$10^{-4}$"]
    assert [label.get_text() for label in panel.get_xticklabels()] == ["1", "$10^{3}$"]


def test_a_sheet_of_maps_holds_four_quantities():
    assert [sheet[:6] for sheet in stability_sheets([made_map(name) for name in "abcde"])] == [PNG] * 2
    with house_style():
        figure = draw_sheet([made_map(name) for name in "abcd"], "1 of 2")
        figure.draw_without_rendering()
        named = [panel.texts[0].get_text() for panel in figure.axes]
        hatched = [sum(patch.get_hatch() is not None for patch in panel.patches) for panel in figure.axes]
    assert named == list("abcd")
    assert hatched == [2] * 4

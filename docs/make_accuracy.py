"""python docs/make_accuracy.py: the table and the picture of docs/accuracy.md, from docs/own_choice*.json."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from marked_tables import write_marked
from matplotlib.figure import Figure

from datagen.drawing.style import BLUE, GREY, INK, VERMILLION, faint_grid, png_of, with_panels
from datagen.files.text_tables import markdown_table

DOCS = Path(__file__).parent
SETS = {"0.1 s": "own_choice.json", "1 s": "own_choice_1s.json"}
CERTAIN = 0.2  # as in tests/benchmarks/own_choice.py, whose summary counts the same scenes
BESIDE = 1.5  # of the outermost dots, to the ends of the axis


def table() -> str:
    """One row a set of scenes."""
    head = ["length", "scenes", "no trajectory converges (called chaotic)", "their spectra apart, at most", "judged"]
    head += ["kept 1e-3", "kept what the recipe asks for", "worst error", "error over its estimate, 5 to 95 %"]
    head += ["cost over hindsight (scenes)"]
    rows = []
    for length, name in SETS.items():
        found = json.loads((DOCS / name).read_text(encoding="utf-8"))["summary"]
        low, _, high = found["error_over_estimate"]
        apart = found["unsettled_spectra_apart_db"]
        cells = [
            length,
            found["scenes"],
            f"{found['unsettled']} ({found['unsettled_called_chaotic']})",
            "–" if apart is None else f"{apart:.1f} dB",
            found["judged"],
            f"{found['kept_the_accuracy']} ({100.0 * found['share_kept']:.1f} %)",
            found["own_accuracy_kept"],
            f"{found['worst_error']:.1e}",
            f"{low:.2f} to {high:.2f}",
            f"{found['cost_over_hindsight']:.2f} ({found['rivalled']})",
        ]
        rows.append(cells)
    return markdown_table(head, rows)


def judged_rows(name: str) -> list[dict[str, Any]]:
    """The scenes of the file `name` on whose trajectory the judge's step sizes agree."""
    found = json.loads((DOCS / name).read_text(encoding="utf-8"))
    return [row for row in found["rows"].values() if row["judge_apart"] <= CERTAIN * found["accuracy"]]


def draw() -> Figure:
    """Error against its estimate, every judged scene a dot that the program does not call chaotic."""
    figure, axes = with_panels(figsize=(6.2, 4.2), layout="constrained")
    faint_grid(axes)
    estimates: list[float] = []
    for (length, name), marker, colour in zip(SETS.items(), "o^", (BLUE, VERMILLION), strict=True):
        judged = [row for row in judged_rows(name) if not row["chaotic"]]
        estimate, error = [row["estimate"] for row in judged], [row["error"] for row in judged]
        estimates += estimate
        label = f"{len(judged)} scenes of {length}"
        axes.loglog(estimate, error, marker, color=colour, markersize=4, alpha=0.6, label=label)
    span = np.array([min(estimates) / BESIDE, max(estimates) * BESIDE])
    axes.plot(span, span, color=GREY, linewidth=1.0, label="error as estimated")
    axes.axhline(1e-3, color=INK, linewidth=1.0, linestyle="--", label="accuracy asked for")
    axes.set(xlabel="estimated error", ylabel="error against fixed steps (relative RMS)", xlim=span)
    axes.set_title("Scenes of the wide corpus, drawn by a seed nothing was tuned with")
    axes.legend(loc="lower right")
    return figure


def main() -> None:
    """Write both."""
    write_marked(DOCS / "accuracy.md", "own choice", __file__, table())
    (DOCS / "pictures" / "own_choice.png").write_bytes(png_of(draw, 130))


if __name__ == "__main__":
    main()

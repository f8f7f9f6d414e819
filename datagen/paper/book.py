"""All chapters together: which there are, and the folder of pictures and tables they make."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from importlib import import_module
from pathlib import Path
from typing import Any

from datagen.drawing.style import png_of
from datagen.errors import BadInput
from datagen.files.atomic import write_results
from datagen.files.plain import plain_json
from datagen.files.results import results_folder
from datagen.paper.chapter import Chapter
from datagen.paper.tables import chapter_csv, page
from datagen.progress import Say, ignore

CHAPTERS = {
    "5": "figure05_load_distribution",
    "6": "figure06_stiffness",
    "7": "figure07_contact_forces",
    "8": "figure08_velocity_spectra",
    "9": "figure09_envelope_spectra",
    "10": "figure10_band_spectra",
    "11": "figure11_fan_rig",
    "q1": "question1_extended_profiles",
    "q2": "question2_unequal_balls",
    "q3": "question3_slip",
}
DPI = 100


def chosen(figures: str | None) -> list[str]:
    """Keys of the chapters named in a list with commas, in the order of the paper; BadInput names an unknown one."""
    if figures is None:
        return list(CHAPTERS)
    asked = [part.strip().lower() for part in figures.split(",")]
    for part in asked:
        if part not in CHAPTERS:
            raise BadInput(field="--figures", value=part, allowed=", ".join(CHAPTERS))
    return [key for key in CHAPTERS if key in asked]


def write_book(out: Path, keys: Sequence[str], say: Say = ignore) -> dict[str, Any]:
    """Compute and draw the chapters `keys` into the folder `out`; returns what paper.json holds.

    For each chapter name.png and name.csv, and for all paper.json and README.md; `say` is called with the title of
    each chapter that is written. Raises BadInput if the folder cannot be made or written into, before anything is
    computed, and where it is full.
    """
    results_folder(out)
    chapters = []
    for key in keys:
        chapter: Chapter = import_module(f"datagen.paper.{CHAPTERS[key]}").chapter()
        # Without the name of the program that wrote it, a picture that did not change is the same file.
        picture = png_of(chapter.draw, DPI, metadata={"Software": None})
        table = chapter_csv(chapter.rows).encode()
        write_results(out, {f"{chapter.name}.png": picture, f"{chapter.name}.csv": table})
        chapters.append(chapter)
        say(chapter.title)
    results = {chapter.name: _facts(chapter) for chapter in chapters}
    write_results(out, {"paper.json": plain_json(results).encode(), "README.md": page(chapters).encode()})
    return results


def _facts(chapter: Chapter) -> dict[str, Any]:
    rows = [asdict(row) | {"difference": row.difference} for row in chapter.rows]
    return {"title": chapter.title, "text": chapter.text, "picture": f"{chapter.name}.png", "rows": rows}

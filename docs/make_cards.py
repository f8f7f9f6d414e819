"""The facts of each dataset's card: `python docs/make_cards.py [NAME ...]` writes them anew.

They follow from the recipe and its expected.json, which `datasets/make_expected.py` writes; for the size on the disk
every scenario is drawn, which takes up to a minute or two a dataset. The prose around them is written by hand.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable
from typing import Any

from marked_tables import ROOT, write_marked

from datagen.counts import bytes_text, digits
from datagen.distributions.distribution import Fixed
from datagen.inspection.recipe_check import RecipeFacts, check_recipe
from datagen.recipes.recipe import Recipe, load_recipe

FOLDER = ROOT / "datasets"
ORDER = ("healthy", "line", "extended", "outer", "inner", "none", "train", "validation", "test")


def card(recipe: Recipe, expected: dict[str, Any], disk: str) -> str:
    """The table of facts of a card, of a dataset that takes about `disk`."""
    rows = {
        "records": f"{expected['records']} of {expected['bearings']} virtual machines, {_runs(recipe)} of each",
        "signal": f"{_values(recipe.signal.duration_s)} s each at {_values(recipe.signal.rate_hz)} Hz",
        "on the disk": disk,
        "conditions": _counts(expected["condition"]),
        "damaged race": _counts(expected["location"]),
        "splits, by machine": _counts(expected["split"]),
        "drawn": f"{_span(expected['speed_rpm'])} rpm, {_span(expected['load_n'])} N, "
        f"spalls of {_span(expected['extent_mm'])} mm",
        "stored besides": _stored(recipe),
        "seed": str(recipe.seed),
    }
    return "\n".join(["| fact | |", "|---|---|", *(f"| {name} | {told} |" for name, told in rows.items())])


def disk_text(facts: RecipeFacts) -> str:
    """About how much room the corpus takes, as `spallgen check` says it, and in how many shards."""
    return f"about {bytes_text(facts.bytes)} in {facts.shards} shards; {facts.signal_seconds:.6g} s of signal"


def _runs(recipe: Recipe) -> str:
    return _listed(sorted({part.records_per_machine for part in recipe.part}))


def _values(setting: Any) -> str:
    """A setting that is fixed or chosen."""
    return _listed([float(setting.value)] if isinstance(setting, Fixed) else sorted(setting.options))


def _listed(values: Iterable[float]) -> str:
    *first, last = (f"{value:.8g}" for value in values)
    return f"{', '.join(first)} or {last}" if first else last


def _counts(counts: dict[str, int]) -> str:
    return ", ".join(f"{name} {counts[name]}" for name in ORDER if name in counts)


def _span(quantiles: dict[str, float]) -> str:
    return f"{digits(quantiles['0'], 3)} to {digits(quantiles['1'], 3)}"


def _stored(recipe: Recipe) -> str:
    """What is stored beyond the usual, by the keys of the recipe."""
    store = recipe.store
    kept = [f"`{name}`" for name, held in store if held is True]
    kept += [] if store.contact_force == "none" else [f'`contact_force` ("{store.contact_force}")']
    return ", ".join(kept) or "nothing"


def main(names: list[str]) -> None:
    """Write the facts of each dataset named, of all if none is."""
    for name in names or sorted(path.parent.name for path in FOLDER.glob("*/recipe.toml")):
        folder = FOLDER / name
        expected = json.loads((folder / "expected.json").read_text(encoding="utf-8"))
        text = card(load_recipe(folder), expected, disk_text(check_recipe(folder)))
        write_marked(folder / "README.md", "facts", __file__, text)
        print(f"{name}: the facts of its card are written")


if __name__ == "__main__":
    main(sys.argv[1:])

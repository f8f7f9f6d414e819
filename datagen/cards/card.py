"""The card as Markdown: short sentences around tables of facts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from datagen.cards.facts import Facts, Kind, Solved
from datagen.corpus_files.format import IMPORTED
from datagen.counts import by_value, bytes_text, digits
from datagen.files.text_tables import markdown_table
from labels.schema import LABEL, LABELS, UNKNOWN

NOT_STATED = "not stated"
OVERVIEW = "overview.png"


def card_text(facts: Facts, source: str, pictures: Mapping[int, str]) -> str:
    """The card of a corpus made from the recipe or SPEC `source` (TOML); `pictures` are files of example records."""
    parts = [
        *_head(facts), *_holdings(facts), *_examples(facts, pictures), *_ranges(facts), *_making(facts, source),
        *_loading(facts), *_terms(facts),
    ]  # fmt: skip
    return "\n".join(parts) + "\n"


def _head(facts: Facts) -> Iterable[str]:
    info = facts.info
    yield f"# {info.title or info.name}\n"
    if facts.summary:
        yield f"{facts.summary}\n"
    kind = "recordings of real machines" if info.origin == IMPORTED else "simulated records with exact labels"
    shortest, longest = facts.durations_s
    length = f"{shortest:g} s" if shortest == longest else f"{shortest:g} to {longest:g} s"
    rows = {
        "name": f"`{info.name}`",
        "kind": kind,
        "records": _records(facts),
        "bearings": f"{info.bearings_text}; label `bearing_id`, never divided between splits",
        "sampling": f"{', '.join(f'{rate:g} Hz' for rate in facts.rates_hz)}; {length} a record",
        "size": f"{info.signal_seconds:.1f} s of signal in {info.shards} shards, {bytes_text(info.bytes)}",
    }
    yield from _table(("", ""), rows.items())


def _records(facts: Facts) -> str:
    info = facts.info
    if info.origin == IMPORTED:
        return str(info.records)
    missing = f", {info.failed} could not be made" if info.failed else ""
    return f"{info.records} of {info.asked} asked for{missing}; the recipe has {info.recipe_records}"


def _source(facts: Facts) -> str:
    return "SPEC" if facts.info.origin == IMPORTED else "recipe"


def _holdings(facts: Facts) -> Iterable[str]:
    yield "## What it holds\n"
    splits = tuple(facts.splits)
    rows = [(kind.condition, kind.location, kind.records, *(kind.by_split.get(s, 0) for s in splits))
            for kind in facts.kinds]  # fmt: skip
    total = ("all", "", facts.info.records, *facts.splits.values())
    yield from _table(("condition", "location", "records", *splits), [*rows, total])
    yield from _asked(facts)
    others = {name: counts for name, counts in facts.info.counts.items() if name not in ("condition", "location")}
    counted = [(f"`{name}`", by_value(counts)) for name, counts in others.items() if name != "split"]
    yield from _table(("label", "records by value"), counted)
    yield f"![Counts and distributions of the labels]({OVERVIEW})\n"


def _asked(facts: Facts) -> Iterable[str]:
    """Records by condition that the recipe asks for, beside those that there are."""
    asked, made = facts.info.asked_by_condition, facts.info.counts["condition"]
    if asked:
        yield f"The weights of the recipe ask for these of {facts.info.asked} records on average:\n"
        rows = [(name, f"{asked.get(name, 0.0):.1f}", made.get(name, 0)) for name in {**asked, **made}]
        yield from _table(("condition", "asked for", "made"), rows)


def _examples(facts: Facts, pictures: Mapping[int, str]) -> Iterable[str]:
    yield "## Examples\n"
    for kind in facts.kinds:
        if kind.first in pictures:
            yield f"Record {kind.first}: {_words(kind)}.\n"
            yield f"![Record {kind.first}]({pictures[kind.first]})\n"


def _words(kind: Kind) -> str:
    known = [word for word in (kind.condition, kind.location) if word not in ("none", UNKNOWN)]
    return ", ".join(known) or "nothing is known of its state"


def _ranges(facts: Facts) -> Iterable[str]:
    yield "## Ranges\n"
    rows = []
    for name, found in facts.info.ranges.items():
        if name == "record":
            continue
        numbers = (digits(value, 5) for value in (found.smallest, found.median, found.largest))
        rows.append((f"`{name}`", found.unit, *numbers, found.missing or ""))
    yield from _table(("label", "unit", "smallest", "median", "largest", "unknown or not applicable"), rows)
    yield "What each label means:\n"
    yield from _table(("label", "meaning"), [(f"`{label.name}`", label.sentence) for label in LABELS])


def _making(facts: Facts, source: str) -> Iterable[str]:
    info = facts.info
    yield "## How it was made\n"
    if info.origin == IMPORTED:
        yield (
            "Each record is the stored numbers of its file times their scale, in m/s², as float32; `provenance` in the "
            "shards names file, SHA-256, variables, scale and notes of each. What the SPEC does not say is unknown.\n"
        )
    else:
        yield from _table(
            ("model", "method", "records", "step", "error estimate: median", "95 %", "largest", "not estimated"),
            [_solved_row(solved) for solved in facts.solved],
        )
        yield f"`error_estimate`: {LABEL['error_estimate'].sentence}\n"
        outside = f"{info.outside_validity} of {info.records} records are to be read with care"
        yield f"{outside}{':' if info.validity else '.'}\n"
        yield from (f"- {count}: {reason}" for reason, count in info.validity.items())
        if info.refused:
            yield "\nImpossible draws, which were drawn again:\n"
            rows = [(what, refused.count, refused.example) for what, refused in info.refused.items()]
            yield from _table(("parameter", "refused", "one of the reasons"), rows)
        yield f"\nCost: {info.worker_seconds:.1f} s of one worker, {info.made_per_second:.2g} times real time.\n"
    hashes = [(name.replace("_", " "), f"`{value}`") for name, value in info.identity.items() if value]
    yield from _table(("identity", "hash"), hashes)
    yield from _table(("made with", "version"), info.made_with.items())
    yield f"The {_source(facts)}, without what is as it is by default:\n"
    yield f"```toml\n{source}```\n"


def _solved_row(solved: Solved) -> Sequence[object]:
    steps = sorted({step for step in (solved.shortest_step, solved.longest_step) if step is not None})
    errors = (solved.median_error, solved.error_95_percent, solved.largest_error)
    return (
        solved.model, solved.method, solved.records, " to ".join(f"{step * 1e6:.3g} µs" for step in steps),
        *("" if error is None else f"{error:.2g}" for error in errors), solved.errors_unknown or "",
    )  # fmt: skip


def _loading(facts: Facts) -> Iterable[str]:
    first = facts.kinds[0]
    yield "## Load it\n"
    yield "```python"
    yield "from datagen.corpus import Corpus"
    yield 'corpus = Corpus("FOLDER")'
    yield f"acceleration, labels = corpus.waveform({first.first}), corpus.labels  # (time, axes), m/s²"
    yield "```\n"
    yield f'or, without spallgen, `xarray.open_dataset("{first.shard}")`.\n'
    yield (
        "`index.csv` has all labels, one row a record. Beside this card, `labels_bearing_datasets.csv` "
        "has them in the words of the package `bearing-datasets`, one row a signal, and `croissant.json` describes the "
        "files to search engines.\n"
    )


def _terms(facts: Facts) -> Iterable[str]:
    yield "## Terms\n"
    terms = {"licence": facts.terms.licence, "citation": facts.terms.citation, "address": facts.terms.url}
    yield from _table(("", ""), [(name, text or NOT_STATED) for name, text in terms.items()])


def _table(heads: Sequence[str], rows: Iterable[Sequence[object]]) -> Iterable[str]:
    yield markdown_table(heads, rows)
    yield ""

"""Results as tables for a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rich.table import Table

from datagen.corpus_files.format import IMPORTED
from datagen.corpus_files.reading import AGAIN
from datagen.counts import by_value, bytes_text, counted, digits
from labels.schema import UNKNOWN

if TYPE_CHECKING:
    from datagen.benchmark.predictions import ModelAnswer, Prediction
    from datagen.inspection.info import Info


def info_tables(info: Info) -> list[Table]:
    """The facts of a corpus, as `spallgen info` shows them."""
    crossed = [_crossed(info, title) for title, rows in info.crossed.items() if _says_something(rows)]
    asked = [_asked(info)] if info.asked_by_condition else []
    refused = [_refused(info)] if info.refused else []
    with_care = [_with_care(info)] if info.validity else []
    return [_summary(info), _counts(info), *asked, *crossed, *refused, *with_care, _ranges(info)]


def _summary(info: Info) -> Table:
    table = Table(title=f"{info.name}: {info.title}" if info.title else info.name, show_header=False)
    present = info.records - sum(info.missing_files.values()) - sum(info.damaged_files.values())
    recorded = info.origin == IMPORTED
    of_recipe = f" of {info.asked} asked for; the recipe has {info.recipe_records}"
    of_recordings = f" of {info.records} recordings" if present < info.records else " recordings"
    rows = {
        "records": f"{present}{of_recordings if recorded else of_recipe}",
        **({"missing": f"{_lost(info.missing_files)}: {AGAIN}"} if info.missing_files else {}),
        **({"damaged": _lost(info.damaged_files)} if info.damaged_files else {}),
        **({"bearings, by split": info.bearings_text} if recorded else _simulated(info)),
        "shards": f"{info.shards}, together {bytes_text(info.bytes)}, {info.record_bytes / 1e6:.2f} MB a record",
        "length": f"{info.signal_seconds:.1f} s of signal",
        **_making(info, recorded),
        "made with": ", ".join(f"{name} {version}" for name, version in info.made_with.items()),
    }
    for name, text in rows.items():
        table.add_row(name, text)
    return table


def _simulated(info: Info) -> dict[str, str]:
    return {
        "could not be made": str(info.failed),
        "virtual bearings": info.bearings_text,
        "to be read with care": counted(info.outside_validity, "record"),
    }


def _making(info: Info, recorded: bool) -> dict[str, str]:
    """What the records cost to make, and the hashes of what they came from; recordings have no model and no cost."""
    if recorded:
        hashes = ("recipe_hash", "format_hash", "program_hash")
        return {"SPEC and files, format, program": ", ".join(info.identity[name] for name in hashes)}
    cost = f"{info.worker_seconds:.1f} s of one worker, {info.record_seconds:.2f} s a record, "
    return {
        "cost": f"{cost}{info.made_per_second:.1f} times real time",
        "recipe, model, format, program": ", ".join(value or "(none)" for value in info.identity.values()),
    }


def _lost(files: dict[str, int]) -> str:
    """Shards that cannot be read, the first three by name, with how many records they have."""
    names = list(files)
    said = ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")
    return f"{said}, with {counted(sum(files.values()), 'record')}, which all other numbers here still count"


def _counts(info: Info) -> Table:
    table = Table("label", "records by value", title="balance")
    for name, counts in info.counts.items():
        if counts.keys() <= {UNKNOWN}:
            continue
        table.add_row(name, by_value(counts))
    nothing = [name for name, counts in info.counts.items() if counts.keys() == {UNKNOWN}]
    if nothing:
        table.add_row("unknown of all", ", ".join(nothing))
    return table


def _says_something(crossed: dict[str, dict[str, int]]) -> bool:
    """False where both labels of a table are unknown of all records."""
    return any(counts.keys() - {UNKNOWN} for counts in crossed.values()) or bool(crossed.keys() - {UNKNOWN})


def _asked(info: Info) -> Table:
    """Records by condition that the recipe asks for, beside those that there are."""
    table = Table("condition", title="records by condition, as the weights of the recipe ask for them and as made")
    for heading in ("asked for", "share", "made", "share"):
        table.add_column(heading, justify="right")
    asked, made = info.asked_by_condition, info.counts["condition"]
    for condition in {**asked, **made}:
        wanted, there = asked.get(condition, 0.0), made.get(condition, 0)
        shares = (f"{wanted / max(info.asked, 1):.1%}", f"{there / max(info.records, 1):.1%}")
        table.add_row(condition, f"{wanted:.1f}", shares[0], str(there), shares[1])
    return table


def _crossed(info: Info, title: str) -> Table:
    """Records by two labels, with the share of each row."""
    rows = info.crossed[title]
    columns = list(dict.fromkeys(value for counts in rows.values() for value in counts))
    table = Table(title.split(" x ")[0], title=f"records by {title.replace(' x ', ' and ')}")
    for heading in (*columns, "all", "share"):
        table.add_column(heading, justify="right")
    for value, counts in rows.items():
        total = sum(counts.values())
        numbers = (str(counts.get(column, "")) for column in columns)
        table.add_row(value, *numbers, str(total), f"{total / max(info.records, 1):.1%}")
    return table


def _refused(info: Info) -> Table:
    table = Table("parameter", title="impossible draws that were drawn again")
    for heading in ("refused", "per record"):
        table.add_column(heading, justify="right")
    table.add_column("for example")
    for what, refused in info.refused.items():
        table.add_row(what, str(refused.count), f"{refused.count / max(info.records, 1):.3f}", refused.example)
    return table


def _with_care(info: Info) -> Table:
    """Why records are to be read with care."""
    table = Table(title="records to be read with care; the label validity has the numbers")
    table.add_column("records", justify="right")
    table.add_column("because")
    for reason, count in info.validity.items():
        table.add_row(str(count), reason)
    return table


def _ranges(info: Info) -> Table:
    table = Table("label", "unit", title="ranges")
    missing = "unknown" if info.origin == IMPORTED else "not applicable"
    for heading in ("smallest", "median", "largest", missing):
        table.add_column(heading, justify="right")
    for name, found in info.ranges.items():
        numbers = (digits(value, 5) for value in (found.smallest, found.median, found.largest))
        table.add_row(name, found.unit, *numbers, str(found.missing or ""))
    return table


def verdict_table(predictions: list[Prediction], models: list[str]) -> Table:
    """What every model says of the records, with its probability of a spall beside the alarm for it, or why a record
    was rejected."""
    table = Table(
        title="records not scored: their true class is unknown or not one of ours",
        caption="In brackets, if the model gives one: the probability of a spall, and the alarm above which one is "
        "called (≈: the vote of axes or windows that disagree decides otherwise; 0: the lines of a race are an alarm "
        "by themselves).",
    )
    for name in ("record", "recording", "stated", *models, "why rejected"):
        table.add_column(name, justify="right" if name == "record" else "left")
    for prediction in predictions:
        facts = (str(prediction.record), prediction.recording, prediction.truth)
        table.add_row(*facts, *(_verdict(prediction.models[model]) for model in models), prediction.rejected)
    return table


def _verdict(said: ModelAnswer) -> str:
    where = said.location
    if where not in (said.location_probability or {}):  # the rule, which gives none, and rejected records
        return where
    return f"{where} ({said.score:.2f} {_beside_alarm(said)} {said.alarm:.2f})"


def _beside_alarm(said: ModelAnswer) -> str:
    """Whether the probability of a spall is above the alarm (> or ≤), or ≈ if that of the whole record contradicts the
    call, which the mean margin of its axes and windows decides."""
    above = said.score > said.alarm
    if above != (said.location != "none"):
        return "≈"
    return ">" if above else "≤"


def catalog_tables() -> list[Table]:
    """Every number of the catalogue with its source, a table for each bearing and rig."""
    from physics.catalog import catalog_rows

    tables: dict[tuple[str, str], Table] = {}
    for row in catalog_rows():
        if (row.kind, row.name) not in tables:
            titles = ("quantity", "value", "unit", "source", "note")
            tables[row.kind, row.name] = Table(*titles, title=f"{row.kind} {row.name}")
        source = f"{row.source} (assumed)" if row.assumed and row.source != "assumed" else row.source
        tables[row.kind, row.name].add_row(row.quantity, f"{row.value:.6g}", row.unit, source, row.note)
    return list(tables.values())


def catalog_data() -> list[dict[str, Any]]:
    """Every number of the catalogue with its source, for other programs."""
    from physics.catalog import catalog_rows

    return [row._asdict() for row in catalog_rows()]

"""Writes the tables of docs/transfer.md from reports of `spallgen classify`: python docs/make_transfer.py REPORT.json …

A report is named by the folder that it lies in; the first is the main run, the others are those of make_ablation.py and
of make_recorded_background.py, whose tables stay as they are without them. A file draws.json is that of make_draws.py.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
from marked_tables import write_marked
from numpy.typing import NDArray
from transfer_page import (
    AUC,
    FAULTS,
    ODD,
    PAGE,
    RACE,
    calibration,
    counted,
    has_faults,
    interval,
    require_different_names,
)

from datagen.errors import BadInput
from datagen.files.text_tables import markdown_table
from labels.classifier.scores import balanced_accuracy, paired_difference
from physics.bearing import RACES

BACKGROUNDS = ("drawn layers", "drawn layers at a ratio", "recording at a ratio")


def without_odd(test: dict[str, Any], model: str) -> str:
    """Balanced accuracy over outer and inner without the odd records, whose envelopes disagree with their label."""
    shares = []
    for race in RACES:
        entries = [entry for entry in test["predictions"] if entry["truth"] == race and entry["recording"] not in ODD]
        if entries:
            shares.append(sum(entry[model]["location"] == race for entry in entries) / len(entries))
    return f"{sum(shares) / len(shares):.3f}" if shares else "–"


def odd_ones(test: dict[str, Any], model: str) -> str:
    """What is said of the odd records."""
    said = [
        f"{entry['recording']} {entry[model]['location']}" for entry in test["predictions"] if entry["recording"] in ODD
    ]
    return ", ".join(said) or "–"


def main_table(report: dict[str, Any]) -> str:
    """One row a corpus and model."""
    head = ["corpus", "model", "outer and inner, all records", "without odd ones", "race alone", "AUC", "minus rule"]
    head += ["false alarms", "calibration error", "rejected", "odd records"]
    rows = []
    for test in report["tests"]:
        for name, scores in test["models"].items():
            minus = scores.get("minus_rule", {}).get(FAULTS)
            cells = [
                Path(test["corpus"]).name,
                name,
                interval(scores[FAULTS]),
                without_odd(test, name),
                interval(scores[RACE]),
                interval(scores[AUC]),
                interval(minus) if minus else "",
                counted(scores["false_alarms"], scores["healthy"]),
                calibration(scores),
                str(scores["rejected"]),
                odd_ones(test, name),
            ]
            rows.append(cells)
    return markdown_table(head, rows)


def noise_table(report: dict[str, Any]) -> str:
    """Faults found at the alarm, race accuracy and AUC under added white noise, with the difference to the rule."""
    names = (FAULTS, RACE, AUC)
    head = ["corpus", "SNR, dB", "model", "outer and inner, at the alarm", "minus rule", "race", "minus rule"]
    head += ["AUC", "minus rule"]
    rows = []
    for test in report["tests"]:
        for noisy in test["noise"]:
            for name, scores in noisy["models"].items():
                minus = scores.get("minus_rule", {})
                cells = [Path(test["corpus"]).name, f"{noisy['snr_db']:g}", name]
                for score in names:
                    cells += [interval(scores[score]), interval(minus[score]) if minus else ""]
                rows.append(cells)
    return markdown_table(head, rows) if rows else "Not run."


def draws_table(draws: dict[str, list[dict[str, dict[str, float | None]]]]) -> str:
    """Mean and range over draws of the training set: faults where there are any, then false alarms."""
    rows = [
        [corpus, model, *(ranged([draw[model][name] for draw in found]) for name in ("faults", "false_alarms"))]
        for corpus, found in draws.items()
        for model in found[0]
    ]
    return markdown_table(["corpus", "model", "outer and inner, without odd ones", "false alarms"], rows)


def ranged(values: list[float | None]) -> str:
    """Mean and range of numbers; a dash where they are not defined."""
    known = [value for value in values if value is not None]
    return f"{np.mean(known):.3f} ({min(known):.3f} to {max(known):.3f})" if known else "–"


def ablation_table(reports: dict[str, dict[str, Any]]) -> str:
    """Balanced accuracy over outer and inner of each report's models: on each imported corpus without odd records, on
    all of them in noise (race and AUC, mean over corpora), and on simulated machines."""
    first = next(iter(reports.values()))
    corpora = [Path(test["corpus"]).name for test in first["tests"] if test["imported"] and has_faults(test)]
    head = ["learned from", "model", *corpora, "false alarms", "race in noise", "AUC in noise", "simulated"]
    rows = []
    for name, report in reports.items():
        tests = {Path(test["corpus"]).name: test for test in report["tests"]}
        for model in next(iter(tests.values()))["models"]:
            cells = [without_odd(tests[corpus], model) for corpus in corpora]
            cells += [alarms(report, model), in_noise(report, model, RACE)]
            cells += [in_noise(report, model, AUC), simulated(report, model)]
            rows.append([name, model, *cells])
    return markdown_table(head, rows)


def left_out_table(reports: dict[str, dict[str, Any]]) -> str:
    """What is lost against the first report without an ingredient, by all learners together: balanced accuracy over
    outer and inner, paired by record and drawn anew by bearing; and the learners' false alarms."""
    full = next(iter(reports.values()))
    learners = [name for name in full["tests"][0]["models"] if name != "rule"]
    head = ["learned from", "minus full recipe, on recordings", "on simulated machines", "false alarms, recordings"]
    head += ["simulated"]
    rows = []
    for name, report in reports.items():
        if report is full:
            continue
        cells = []
        for imported in (True, False):
            truth, answer, bearing = called(report, learners, imported)
            _, full_answer, _ = called(full, learners, imported)
            lost = paired_difference(balanced_accuracy, truth, answer, full_answer, strata=truth, groups=bearing)
            cells.append(f"{lost.value:+.3f} [{lost.low:+.3f}, {lost.high:+.3f}]")
        cells += [learners_alarms(report, learners, imported) for imported in (True, False)]
        rows.append([name, *cells])
    return markdown_table(head, rows)


def called(
    report: dict[str, Any], models: list[str], imported: bool
) -> tuple[NDArray[np.str_], NDArray[np.str_], NDArray[np.str_]]:
    """True race, what is called, and which bearing it is, of all faults but odd ones, one row a record and model."""
    rows = [
        (entry["truth"], entry[model]["location"], f"{test['corpus']} {entry['bearing_id']}")
        for test in report["tests"]
        if test["imported"] == imported
        for entry in test["predictions"]
        if entry["truth"] in RACES and entry["recording"] not in ODD
        for model in models
    ]
    truth, answer, bearing = zip(*rows, strict=True)
    return np.array(truth), np.array(answer), np.array(bearing)


def learners_alarms(report: dict[str, Any], models: list[str], imported: bool) -> str:
    """Fewest and most false alarms of the models, of so many healthy records."""
    tests = [test["models"] for test in report["tests"] if test["imported"] == imported]
    counts = [sum(test[model]["false_alarms"] for test in tests) for model in models]
    span = f"{min(counts)} to {max(counts)}" if min(counts) < max(counts) else f"{counts[0]}"
    return f"{span} of {sum(test[models[0]]['healthy'] for test in tests)}"


def alarms(report: dict[str, Any], model: str) -> str:
    """False alarms over healthy recordings of all imported corpora."""
    on_recordings = [test["models"][model] for test in report["tests"] if test["imported"]]
    false, healthy = (sum(scores[name] for scores in on_recordings) for name in ("false_alarms", "healthy"))
    return f"{false} of {healthy}"


def in_noise(report: dict[str, Any], model: str, score: str) -> str:
    """Mean of a score over the imported corpora and levels at which noise was added."""
    values = [
        noisy["models"][model][score]["value"]
        for test in report["tests"]
        if test["imported"]
        for noisy in test["noise"]
    ]
    known = [value for value in values if value is not None]
    return f"{sum(known) / len(known):.3f}" if known else "–"


def simulated(report: dict[str, Any], model: str) -> str:
    """Balanced accuracy over outer and inner of simulated records, with its interval."""
    on_machines = [test["models"][model] for test in report["tests"] if not test["imported"]]
    return interval(on_machines[0][FAULTS]) if on_machines else "–"


def main(paths: list[Path]) -> None:
    """Write the tables; raises BadInput without a report, and where two of them lie in folders of one name."""
    draws = [path for path in paths if path.name == "draws.json"]
    others = [path for path in paths if path not in draws]
    if not others:
        raise BadInput("no report of the main run", field="FILE", allowed="its report.json before all others")
    require_different_names(path.absolute().parent for path in others)
    reports = {path.absolute().parent.name: json.loads(path.read_text()) for path in others}
    first = next(iter(reports.values()))
    learned = f"Learned from {first['training_records']} simulated records; no real one."
    tables = {"scores": f"{learned}\n\n{main_table(first)}", "noise": noise_table(first)}
    for path in draws:
        tables["draws"] = draws_table(json.loads(path.read_text()))
    ablations = dict(list(reports.items())[1:])
    backgrounds = {name: ablations.pop(name) for name in BACKGROUNDS if name in ablations}
    for name, found in (("ablation", ablations), ("background", backgrounds)):
        if found:
            tables[name] = ablation_table(found)
    if ablations:
        tables["left out"] = left_out_table(ablations)
    for name, text in tables.items():
        write_marked(PAGE, name, __file__, text)


def command_line() -> argparse.Namespace:
    """What was asked for on the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "paths", nargs="+", type=Path, metavar="FILE", help="report.json of the main run, then others or draws.json"
    )
    return parser.parse_args()


if __name__ == "__main__":
    asked = command_line()
    main(asked.paths)

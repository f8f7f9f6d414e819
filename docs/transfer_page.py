"""What the scripts of docs/transfer.md share: which recordings are odd, the names of scores in reports, and cells."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from datagen.errors import BadInput
from labels.classifier.scores import FEWEST_A_SIDE, exact_interval
from physics.bearing import RACES

PAGE = Path(__file__).with_name("transfer.md")
CROSSFITTED, NOISE_AUC = PAGE.with_name("crossfitted.json"), PAGE.with_name("noise_auc.json")
FAULTS, RACE, AUC = "faults_balanced_accuracy", "race_accuracy", "detection_auc"
# Recordings of CWRU whose envelopes disagree with their label (docs/transfer.md), scored apart: of the drive end at
# 12 kHz, and at 48 kHz.
ODD = ("197", "198", "199", "174", "201")


def require_different_names(folders: Iterable[Path]) -> None:
    """Raise BadInput where two folders have one name, by which what is found in them is kept."""
    counts = Counter(folder.absolute().name for folder in folders)
    twice = ", ".join(name for name, count in counts.items() if count > 1)
    if twice:
        raise BadInput(
            "several folders are called so", value=twice, field="FOLDER", allowed="a name of its own for each"
        )


def interval(found: dict[str, Any]) -> str:
    """A score with its interval if it has one; a dash where it is not defined."""
    if found["value"] is None:
        return "–"
    if found["low"] is None:
        return f"{found['value']:.3f}"
    return f"{found['value']:.3f} [{found['low']:.3f}, {found['high']:.3f}]"


def counted(some: int, all_: int) -> str:
    """A count with the 95 % interval of its share [Clopper & Pearson 1934]; a dash if nothing was counted."""
    if all_ == 0:
        return "–"
    share = exact_interval(some, all_)
    return f"{some} of {all_} [{share.low:.3f}, {share.high:.3f}]"


def calibration(scores: dict[str, Any]) -> str:
    """The calibration error; a dash for the rule, and with too few healthy records or faults to tell."""
    by_truth = zip(scores["confusion"]["rows"], scores["confusion"]["counts"], strict=True)
    faults = sum(sum(counts) for truth, counts in by_truth if truth in RACES)
    few = min(scores["healthy"], faults) < FEWEST_A_SIDE
    return "–" if few or "calibration_error" not in scores else f"{scores['calibration_error']:.3f}"


def has_faults(test: dict[str, Any]) -> bool:
    """Whether a corpus of a report has faults of the races."""
    return bool(test["locations"]["outer"] + test["locations"]["inner"])

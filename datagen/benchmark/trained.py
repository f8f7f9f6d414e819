"""The models that `classify` has trained, and the file in which they are saved for later recordings."""

from __future__ import annotations

import json
import pickle
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from datagen.benchmark.machines import LearnedMachines
from datagen.benchmark.options import SAVE, TRAIN, Learning
from datagen.benchmark.training import Model
from datagen.errors import BadInput, unreadable
from datagen.files.atomic import write_file
from datagen.versions import measured_on, program_hash
from labels.classifier.rule import Rule

FORMAT = "spallgen classifiers 1"
AGAIN = f"learn again, with {SAVE}"
MADE_WITH = ("python", "scikit-learn", "numpy", "scipy")
# The packages that make rows and learn from them, by what they are called in the head of a file.
CODE = {
    "features": ("labels", "labels/classifier", "labels/features"),
    "benchmark": ("datagen/benchmark", "datagen/judging"),
}
LONGEST_HEAD = 10_000


@dataclass(frozen=True)
class Trained:
    """The rule and the models; the `machines` they must not be scored on (None: plain impulse trains have none); the
    options of `learning`; the hash of the `recipe` learned from, "" without; and the `facts` of the report that follow
    from learning alone."""

    rule: Rule
    models: list[Model]
    machines: LearnedMachines | None
    learning: Learning
    recipe: str
    facts: dict[str, Any]


def is_saved(train: Path) -> bool:
    """Whether `--train` names a file of learned classifiers and no corpus."""
    return train.is_file()


def save_trained(path: Path, trained: Trained) -> None:
    """Keep what was learned at `path`, a line of JSON that says with what and a compressed pickle; raises BadInput."""
    head = json.dumps({"format": FORMAT} | _made_with()).encode() + b"\n"
    write_file(path, head + zlib.compress(pickle.dumps(trained), 1), SAVE)


def load_trained(path: Path) -> Trained:
    """What was saved at `path`.

    Raises BadInput unless it was saved with these versions of Python, of the packages that learning rests on, and of
    the features and the benchmark. Nothing is unpickled before that is known.
    """
    try:
        with path.open("rb") as file:
            _require_same(path, _head(file.readline(LONGEST_HEAD)))
            kept = file.read()
    except OSError as problem:
        raise unreadable(path, problem, TRAIN) from None
    try:
        trained = pickle.loads(zlib.decompress(kept))
    except Exception:  # whatever a damaged pickle leads to
        trained = None
    if not isinstance(trained, Trained):
        raise BadInput("is damaged", file=str(path), field=TRAIN, allowed=AGAIN)
    return trained


def _require_same(path: Path, head: dict[str, Any]) -> None:
    """Raise BadInput unless the `head` of a file says that it was made by what runs now."""
    if head.get("format") != FORMAT:
        raise BadInput(
            "holds no learned classifiers", file=str(path), field=TRAIN, allowed=f"a corpus, or what {SAVE} wrote"
        )
    for name, now in _made_with().items():
        if head.get(name) != now:
            raise BadInput(
                f"was learned with {name} {head.get(name)}, and this is {now}",
                file=str(path),
                field=TRAIN,
                allowed=AGAIN,
            )


def _head(line: bytes) -> dict[str, Any]:
    try:
        found = json.loads(line)
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}


def _made_with() -> dict[str, str]:
    versions = measured_on(*MADE_WITH[1:])
    return {name: versions[name] for name in MADE_WITH} | {
        name: program_hash(*packages) for name, packages in CODE.items()
    }

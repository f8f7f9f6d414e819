"""The options of `classify`, as they are logged with every run."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

from datagen.files.number_texts import number
from datagen.judging.stated_speed import SPEED_ERROR

FEATURES, WINDOWS = "features", "windows"
# What refusals call the options of `classify`.
SAVE, TRAIN, TEST_ON, FIRST = "--save", "--train", "--test", "--first"
# What `--train` calls the rows of features that come with the program.
TRANSFER_ROWS = "transfer-rows"


@dataclass(frozen=True)
class Learning:
    """The options of learning. They are saved with the trained models, since they hold whenever these are used again.

    `learner` is one of ours or "all"; `estimator` names the user's own (None: ours are used) and `input` says what that
    is given. `bandwidth` (Hz) limits all records (None: as usual); `speed_error` is the largest relative error of the
    speeds used in training; `first` is how many records are learned from (None: all).
    """

    learner: str = "all"
    estimator: str | None = None
    input: str = FEATURES
    bandwidth: float | None = None
    speed_error: float = SPEED_ERROR
    first: int | None = None

    @property
    def takes_windows(self) -> bool:
        """True if the estimator is given raw windows."""
        return self.input == WINDOWS


@dataclass(frozen=True)
class Scoring:
    """The options of scoring: answers with a probability below `reject` are rejected; recordings of faults are also
    scored with noise added at the ratios `noise_db` (dB, a text with commas), in `noise_draws` draws each."""

    reject: float = 0.0
    noise_db: str = ""
    noise_draws: int = 10

    @property
    def levels(self) -> tuple[float, ...]:
        """Signal-to-noise ratios, dB, of the noise to add; NaN for what is no number."""
        return tuple(number(part) for part in self.noise_db.split(",") if part.strip())


@dataclass(frozen=True)
class Options:
    """All options of a run."""

    learning: Learning = field(default_factory=Learning)
    scoring: Scoring = field(default_factory=Scoring)

    def to_dict(self) -> dict[str, Any]:
        """Every option by its name on the command line."""
        return asdict(self.learning) | asdict(self.scoring)

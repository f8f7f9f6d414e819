"""What shorter, resampled, clipped or otherwise worse recordings change: python docs/make_disturbed.py TRAIN TEST…

Learns once from all of TRAIN, disturbs the recordings of every TEST in memory, scores them as `spallgen classify` does,
and writes the table of docs/transfer.md. Recordings with a shaft angle are refused: what disturbs a signal leaves the
angle as it was.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from joblib import Parallel, delayed
from marked_tables import write_marked
from numpy.typing import NDArray
from scipy.signal import fftconvolve, resample_poly
from transfer_page import ODD, PAGE

from datagen.benchmark.chosen import ChosenRecords, chosen_records
from datagen.benchmark.corpus_rows import CorpusRows, rows_of_records
from datagen.benchmark.plan import Benchmark
from datagen.benchmark.reading_policy import Reading
from datagen.benchmark.record_rows import RecordRows, record_rows
from datagen.benchmark.summary import race_balance
from datagen.benchmark.training import train_models, train_rule, training_records, training_set
from datagen.benchmark.verdicts import Judges, Tested
from datagen.corpus import Corpus
from datagen.errors import BadInput
from datagen.files.text_tables import markdown_table
from datagen.judging.scored_runs import write_line
from labels.variables import SHAFT_ANGLE
from physics.bearing import RACES

if TYPE_CHECKING:
    import pandas

SEED, WORKERS = 20261122, 2
# Seconds after which a knock has died away.
RINGS_FOR = 0.02
Signal = NDArray[np.float64]


class Recorded(NamedTuple):
    """Samples (T, A), their `rate` (Hz), what the stated speed is multiplied by, and whether it is given as nominal."""

    signal: Signal
    rate: float
    speed_factor: float = 1.0
    nominal: bool = False


def cut(signal: Signal, rate: float, random: np.random.Generator, seconds: float) -> Recorded:
    """A stretch of so many seconds, anywhere in the record."""
    size = min(round(seconds * rate), len(signal))
    start = int(random.integers(0, len(signal) - size, endpoint=True))
    return Recorded(signal[start : start + size], rate)


def resampled(signal: Signal, rate: float, _: np.random.Generator, to: float) -> Recorded:
    """The record at another rate (Hz)."""
    ratio = Fraction(round(to), round(rate))
    return Recorded(resample_poly(signal, ratio.numerator, ratio.denominator, axis=0), to)


def misstated(signal: Signal, rate: float, _: np.random.Generator, by: float, nominal: bool = False) -> Recorded:
    """The record with a wrong speed."""
    return Recorded(signal, rate, by, nominal)


def clipped(signal: Signal, rate: float, _: np.random.Generator, at: float) -> Recorded:
    """The record cut off, on either side of 0, at so many times the RMS about its mean."""
    level = at * signal.std(axis=0)
    return Recorded(np.clip(signal, -level, level), rate)


def coarse(signal: Signal, rate: float, _: np.random.Generator, steps: float) -> Recorded:
    """The record in whole steps, so many up to its largest value."""
    step = np.abs(signal).max(axis=0) / steps
    return Recorded(np.round(signal / step) * step, rate)


def stepping(signal: Signal, rate: float, random: np.random.Generator, height: float) -> Recorded:
    """The record with a step of its offset, so many times its RMS, anywhere in its middle half."""
    at = round(random.uniform(0.25, 0.75) * len(signal))
    return Recorded(signal + height * signal.std(axis=0) * (np.arange(len(signal)) >= at)[:, None], rate)


def humming(signal: Signal, rate: float, _: np.random.Generator, hertz: float) -> Recorded:
    """The record with hum of its own RMS at a mains frequency, and of 1/√18 of it (0.24) at the third harmonic."""
    turn = 2.0 * np.pi * hertz * np.arange(len(signal))[:, None] / rate
    return Recorded(signal + signal.std(axis=0) * (np.sqrt(2.0) * np.sin(turn) + np.sin(3.0 * turn) / 3.0), rate)


def knocking(signal: Signal, rate: float, random: np.random.Generator, hertz: float) -> Recorded:
    """The record with knocks of another shaft, so many a second with 1 % jitter, whose heights scatter by a tenth, that
    ring for 2 ms at a tone between 1 and 4 kHz and have the record's RMS."""
    count = int(hertz * len(signal) / rate)
    at = (np.arange(count) + random.uniform() + 0.01 * random.normal(size=count)) / hertz
    impulses = np.zeros(len(signal))
    np.add.at(impulses, np.clip(at * rate, 0, len(signal) - 1).astype(np.int64), 1.0 + 0.1 * random.normal(size=count))
    time = np.arange(0.0, RINGS_FOR, 1.0 / rate)
    ringing = fftconvolve(impulses, np.exp(-500.0 * time) * np.sin(2.0 * np.pi * random.uniform(1e3, 4e3) * time))
    knocks = ringing[: len(signal), None]
    return Recorded(signal + signal.std(axis=0) * knocks / knocks.std(), rate)


DISTURBANCES: dict[str, Callable[[Signal, float, np.random.Generator], Recorded]] = {
    "as recorded": partial(misstated, by=1.0),
    "1 s of it": partial(cut, seconds=1.0),
    "0.5 s of it": partial(cut, seconds=0.5),
    "0.25 s of it": partial(cut, seconds=0.25),
    "at 10 kHz": partial(resampled, to=10_000.0),
    "at 25.6 kHz": partial(resampled, to=25_600.0),
    "speed stated 2 % too high": partial(misstated, by=1.02),
    "speed stated 2 % too low": partial(misstated, by=0.98),
    "speed stated 4 % too high, as nominal": partial(misstated, by=1.04, nominal=True),
    "speed stated 4 % too low, as nominal": partial(misstated, by=0.96, nominal=True),
    "clipped at 3 times its RMS": partial(clipped, at=3.0),
    "in 100 steps up to its peak": partial(coarse, steps=100.0),
    "with a step of its offset, 5 times its RMS": partial(stepping, height=5.0),
    "with as much mains hum": partial(humming, hertz=50.0),
    "with knocks of another shaft, 9.3 a second": partial(knocking, hertz=9.3),
    "with knocks of another shaft, 41 a second": partial(knocking, hertz=41.0),
    "with knocks of another shaft, 57 a second": partial(knocking, hertz=57.0),
}


def require_no_angle(folder: Path) -> None:
    """Raise BadInput if any record of a corpus has a shaft angle, by which `spallgen classify` would read it."""
    with Corpus(folder) as corpus:
        for record in corpus.labels["record"].tolist():
            if corpus.has(record, SHAFT_ANGLE.name):
                problem = f"record {record} has a shaft angle, which cannot be disturbed with its signal"
                raise BadInput(problem, file=str(folder), field="TEST", allowed="records without a shaft angle")


def read(folder: Path, label: pandas.Series[Any], name: str) -> RecordRows:
    """Rows of one disturbed record."""
    with Corpus(folder) as corpus:
        signal = np.asarray(corpus.waveform(int(label["record"])), dtype=np.float64)
    random = np.random.default_rng([SEED, int(label["record"])])
    found = DISTURBANCES[name](signal, float(label["rate_hz"]), random)
    disturbed = label.copy()
    disturbed["rate_hz"], disturbed["speed_rpm"] = found.rate, found.speed_factor * float(label["speed_rpm"])
    if found.nominal:
        disturbed["speed_basis"] = "nominal"
    return record_rows(found.signal, disturbed, Reading())


def rows_of(chosen: ChosenRecords, name: str) -> CorpusRows:
    """The rows of all records, disturbed."""
    found = Parallel(WORKERS)(delayed(read)(chosen.folder, label, name) for _, label in chosen.labels.iterrows())
    return rows_of_records(dict(zip(chosen.numbers.tolist(), found, strict=True)))


def scores(tested: list[Tested]) -> list[tuple[str, str, str, str]]:
    """By model: its name, balanced accuracy without odd records, share of right races, and false alarms."""
    truth = np.concatenate([draw.truth for draw in tested])
    names = np.concatenate([draw.chosen.labels["recording"].astype(str).to_numpy() for draw in tested])
    faulty, healthy = np.isin(truth, RACES) & ~np.isin(names, ODD), truth == "none"
    found = []
    for place, model in enumerate(verdicts.name for verdicts in tested[0].verdicts):
        said = np.concatenate([draw.verdicts[place].location for draw in tested])
        race = np.concatenate([draw.verdicts[place].race for draw in tested])
        alarms = int(np.isin(said[healthy], RACES).sum())
        balance = race_balance(truth[faulty], said[faulty])
        right = float(np.mean(race[faulty] == truth[faulty]))
        found.append((model, f"{balance:.3f}", f"{right:.3f}", f"{alarms} of {int(healthy.sum())}"))
    return found


def main(train: Path, tests: list[Path]) -> None:
    """Score every disturbance and write the table; raises BadInput before anything is learned."""
    for folder in tests:
        require_no_angle(folder)
    training = training_set(train, training_records(train, False), Benchmark(train, ()).training_reading(), WORKERS)
    judges = Judges(train_rule(training), train_models(training, "all"))
    names = ["rule", *(model.name for model in judges.models)]
    rows = []
    whole = [chosen_records(folder, None) for folder in tests]
    for name in DISTURBANCES:
        found = scores([judges.judge(chosen, rows_of(chosen, name)) for chosen in whole])
        for folder in tests:
            write_line(folder, {"disturbed": name, "train": str(train), "with": list(map(str, tests)), "scores": found})
        rows.append([name, *(f"{faults}, {race}, {alarms}" for _, faults, race, alarms in found)])
        print(*rows[-1], sep=" | ", flush=True)
    table = markdown_table(["recordings", *(f"{name}: faults, race, false alarms" for name in names)], rows)
    learned = f"Learned from {len(np.unique(training.rows.record))} simulated records."
    write_marked(PAGE, "disturbed", __file__, f"{table}\n\n{learned}")


def command_line() -> argparse.Namespace:
    """What was asked for on the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("train", type=Path, metavar="TRAIN", help="corpus to learn from")
    parser.add_argument("tests", nargs="+", type=Path, metavar="TEST", help="corpus of recordings to disturb and score")
    return parser.parse_args()


if __name__ == "__main__":
    asked = command_line()
    main(asked.train, asked.tests)

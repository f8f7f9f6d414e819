"""One opened file of a recording: its samples and numbers as the SPEC's settings ask for them."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.errors import BadInput, at_line
from datagen.formats.arrays import Arrays, NoVariable, choose, chosen
from datagen.formats.csv_file import Columns
from datagen.formats.placeholders import filled, place_without_ending
from datagen.recipes.signal_settings import FEWEST_STORED_SAMPLES
from datagen.recordings.listing import Request
from datagen.recordings.sample_times import rate_of
from datagen.recordings.values import RANGES, FromVariable, in_range
from labels.filling import straight
from physics.arrays import Array

LONGEST_CELL = 40
FILL = "fill"
# Samples in a row, and the share of all, that may be missing and filled.
LONGEST_GAP, MOST_MISSING = 10, 0.01
# What cannot have a mean: several numbers are then those of several channels or bearings.
CONSTANT = ("rate_hz", "scale", "bpfo", "bpfi", "bsf", "ftf", "extent_mm", "extent_deg", "depth_um")
# Ratio of the largest to the smallest from which a few numbers are not those of one machine along the recording.
SEVERAL = 1.5
# What is allowed where a variable does not give one number.
ONE_OF_THEM = 'a single number of it, as in "NAME[0]" or "NAME[0,2]"'
MOST_OF_THEM = "finite numbers throughout, as missing_samples fills channels only; or a single number, as NAME[0]"
FACTOR = "factor brings times to s: 1e-3 those in ms, 1e-6 those in µs, 1e-9 those in ns"
ANOTHER_UNIT = "factor = … brings it to the unit of the setting, as 1000 a rate in kHz"
TIMES = "times in s; of dates and hours of a clock the rate itself, a number"
Span = tuple[Fraction, Fraction]
WHOLE = (Fraction(0), Fraction(1))


@dataclass(frozen=True)
class Source:
    """The file of a request, opened; every method raises BadInput naming file, setting and value."""

    request: Request
    arrays: Arrays

    @property
    def path(self) -> Path:
        """The file."""
        return self.request.path

    def refusal(self, problem: str, field: str, value: object, allowed: str = "") -> BadInput:
        """The refusal of what this file holds, or of what the SPEC wants of it, under the name of its setting."""
        return BadInput(problem, file=str(self.path), field=field, value=value, allowed=allowed)

    def setting(self, name: str, default: Any = None) -> Any:
        """A setting as the SPEC says it, `default` if it says nothing."""
        return self.request.settings.get(name, default)

    def text(self, name: str, default: str) -> str:
        """A text that names something, what stands in braces filled in; `default` if the SPEC says nothing."""
        said, request = self.setting(name), self.request
        if said is None:
            return default
        more = {"path": place_without_ending(request.name), "channel": request.channel.name}
        text = filled(said, self.path, name, more).strip()
        if not text:
            raise self.refusal("is empty for this file", name, said, "a name")
        return text

    def array(self, wish: str, field: str, fill: Callable[[Array, NDArray[np.intp]], Array] = straight) -> Array:
        """The samples (T,) of a variable: finite numbers, at least 16, short gaps filled by `fill` if the SPEC asks for
        that."""
        found = self._row(wish, field)
        if found.size < FEWEST_STORED_SAMPLES:
            raise self.refusal(f"holds {found.size} samples", field, wish, f"at least {FEWEST_STORED_SAMPLES} samples")
        values = found.astype(np.float64)
        bad = self.missing(wish, field)
        if not bad.size:
            return values
        empty = self._empty(wish, field)
        fits = empty and longest_run(bad) <= LONGEST_GAP and bad.size <= MOST_MISSING * values.size
        most = f"empty or NaN, at most {LONGEST_GAP} in a row and {MOST_MISSING:.0%} of all"
        if self.setting("missing_samples") != FILL:
            allowed = ""
            if fits:
                allowed = f'finite numbers, or missing_samples = "{FILL}"'
            elif empty:
                allowed = f"finite numbers; they can be filled where they are {most}"
            raise self._not_finite(bad, values.size, wish, field, allowed)
        if not fits:
            raise self._not_finite(bad, values.size, wish, field, f"what is filled must be {most}")
        return fill(values, bad)

    def instants(self, wish: str, field: str) -> Array:
        """The rising finite numbers (N,) that a variable lists, without what is missing behind the last of them, as in
        a column of a table that is shorter than others."""
        found = self._row(wish, field).astype(np.float64)
        missing = self.missing(wish, field)
        told = found[: np.flatnonzero(np.isfinite(found)).max(initial=-1) + 1]
        if missing.size and (missing[0] < told.size or not self._empty(wish, field)):
            raise self._not_finite(missing, found.size, wish, field, "times alone")
        falls = np.flatnonzero(np.diff(told) <= 0.0)
        if falls.size:
            at = falls[0]
            raise self.refusal(f"{told[at + 1]:g} follows {told[at]:g}", field, wish, "times that rise throughout")
        return told

    def first_time(self) -> float:
        """Time of the first sample, s, where the file holds the times of its samples; otherwise 0."""
        said = self.setting("rate_hz")
        if not isinstance(said, FromVariable) or not said.times:
            return 0.0
        times = choose(self.arrays, said.variable, self.path, "rate_hz")
        return float(times[0]) * said.factor if times.ndim == 1 and times.size > 1 else 0.0

    def _row(self, wish: str, field: str) -> NDArray[Any]:
        """The real numbers (T,) of a variable that is a single channel."""
        found = choose(self.arrays, wish, self.path, field)
        if found.dtype.kind not in "iuf":
            raise self.refusal(f"holds {found.dtype}, not real numbers", field, wish)
        if found.ndim != 1 and found.size:
            shape = "x".join(map(str, found.shape)) or "one number"
            lying = found.ndim == 2 and found.shape[0] < found.shape[1]
            allowed = 'one row, as in "NAME[0,:]"' if lying else 'one column, as in "NAME[:,0]"'
            raise self.refusal(f"is not a single channel ({shape})", field, wish, allowed)
        return found

    def _empty(self, wish: str, field: str) -> bool:
        """Whether all samples that are not numbers are empty, as far as a text table shows that, and not some other
        text."""
        name, places = chosen(self.arrays, wish, self.path, field)
        if not isinstance(self.arrays, Columns) or places is not None:
            return True
        return name not in self.arrays.worded

    def missing(self, wish: str, field: str) -> NDArray[np.intp]:
        """Which samples of a variable are not finite numbers."""
        return np.flatnonzero(~np.isfinite(choose(self.arrays, wish, self.path, field)))

    def _not_finite(self, bad: NDArray[np.intp], size: int, wish: str, field: str, allowed: str) -> BadInput:
        name, places = chosen(self.arrays, wish, self.path, field)
        if isinstance(self.arrays, Columns) and places is None:
            first = self.arrays.odd[name]
            # Where gaps are to be filled, it is a text that is none which is wrong.
            line, text = self.arrays.worded.get(name, first) if self.setting("missing_samples") == FILL else first
            which = "the first is" if (line, text) == first else "one of them is"
            shown = json.dumps(text[:LONGEST_CELL], ensure_ascii=False)
            problem = f"{bad.size} of {size} cells are not finite numbers, {which} {shown}{self.arrays.hint}"
            return BadInput(problem, file=at_line(self.path, line), field=field, value=wish, allowed=allowed)
        if size == 1:
            return self.refusal("is not a finite number", field, wish)
        problem = f"{bad.size} of {size} samples are not finite numbers, the first at sample {bad[0]} (from 0)"
        return self.refusal(problem, field, wish, allowed)

    def variable(self, wish: str, field: str) -> str:
        """Name of the variable that the SPEC's `wish` means in this file, "" if there is none."""
        try:
            name, places = chosen(self.arrays, wish, self.path, field)
        except NoVariable:
            return ""
        return name if places is None else f"{name}[{places}]"

    def number(self, name: str, span: Span = WHOLE) -> float | None:
        """A number in its range that is stated or that the file holds; None if the SPEC says nothing of it.

        Of a row of numbers, the mean over a `span` of the recording, as shares of its length; of what cannot have one,
        such as a sampling rate, the only one, or what follows from times. NoVariable if the file lacks the variable.
        """
        said = self.setting(name)
        if not isinstance(said, FromVariable):
            return None if said is None else float(said)
        value = self._value(self._finite_numbers(said, name), said, name, span)
        if not in_range(name, value):
            problem = f"from the variable {said.variable}" + (", whose times are read as s" if said.times else "")
            remark = FACTOR if said.times else ANOTHER_UNIT if said.factor == 1.0 else ""
            allowed = "; ".join(filter(None, [RANGES[name].allowed(), remark]))
            raise self.refusal(problem, name, value, allowed)
        return value

    def _finite_numbers(self, said: FromVariable, field: str) -> NDArray[Any]:
        """The numbers of a variable, at least one; BadInput unless all are finite."""
        found = choose(self.arrays, said.variable, self.path, field)
        if found.dtype.kind not in "iuf" or not found.size:
            allowed = TIMES if said.times else ""
            raise self.refusal("is not a finite number", field, said.variable, allowed)
        bad = np.flatnonzero(~np.isfinite(found))
        if bad.size:
            one = MOST_OF_THEM if bad.size < found.size / 2 else ONE_OF_THEM
            allowed = TIMES if said.times else one if bad.size < found.size else ""
            raise self._not_finite(bad, found.size, said.variable, field, allowed)
        return found

    def _value(self, found: NDArray[Any], said: FromVariable, field: str, span: Span) -> float:
        """The one number that the numbers `found` in a variable stand for."""
        if said.times:
            with np.errstate(over="ignore"):
                times = found.astype(np.float64) * said.factor
            return rate_of(times, self.path, said.variable)
        if field in CONSTANT and np.ptp(found) > 0.0:
            also = ", or the times of the samples with times = true" if field == "rate_hz" else ""
            raise self._several(found, said.variable, field, "a variable that holds one number, or one of it" + also)
        self._require_one_course(found, said.variable, field)
        return self._mean(_within(found, span), said.variable, field) * said.factor

    def _mean(self, found: NDArray[Any], wish: str, field: str) -> float:
        zeros = found.size - np.count_nonzero(found)
        if found.size / 2 < zeros < found.size:
            raise self.refusal(
                f"is 0 in {zeros} of {found.size} places, so its mean means nothing", field, wish, ONE_OF_THEM
            )
        return float(np.mean(found, dtype=np.float64))

    def _require_one_course(self, found: NDArray[Any], wish: str, field: str) -> None:
        """Raise BadInput for numbers of which a mean would mix those of several shafts: different ones in a table, or a
        few that are far apart."""
        low, high = float(np.abs(found).min()), float(np.abs(found).max())
        few = found.ndim == 1 and found.size < FEWEST_STORED_SAMPLES and high > SEVERAL * low
        if few or (found.ndim > 1 and np.ptp(found) > 0.0):
            raise self._several(
                found, wish, field, ONE_OF_THEM if few else f'{ONE_OF_THEM}, or one column, "NAME[:,0]"'
            )

    def _several(self, found: NDArray[Any], wish: str, field: str, allowed: str) -> BadInput:
        """The error for a variable that holds several numbers where one is needed."""
        name, _ = chosen(self.arrays, wish, self.path, field)
        shape = "x".join(map(str, np.shape(self.arrays[name])))
        problem = f"holds {found.size} numbers from {found.min():g} to {found.max():g} ({name} is {shape})"
        return self.refusal(problem, field, wish, allowed)

    def course(self, name: str, span: Span = WHOLE) -> Array | None:
        """The numbers (N,), 0 or above, that a variable holds along a `span` of the recording; None if it holds no such
        row, or nothing but 0 throughout."""
        said = self.setting(name)
        if not isinstance(said, FromVariable) or not self.variable(said.variable, name):
            return None
        found = choose(self.arrays, said.variable, self.path, name)
        if found.ndim != 1 or found.dtype.kind not in "iuf" or found.size < FEWEST_STORED_SAMPLES:
            return None
        numbers = found.astype(np.float64) * said.factor
        return _within(numbers, span) if (numbers >= 0.0).all() and numbers.any() else None

    def or_none(self, name: str, span: Span = WHOLE) -> float | None:
        """As `number`, but None where the file lacks the variable."""
        try:
            return self.number(name, span)
        except NoVariable:
            return None


def longest_run(places: NDArray[np.intp]) -> int:
    """The most of the rising `places` (N,), at least one, that follow each other."""
    ends = np.flatnonzero(np.diff(places, append=places[-1] + 2) > 1)
    return int(np.diff(ends, prepend=-1).max())


def span_of(start: int, stop: int, size: int) -> Span:
    """The samples from `start` to before `stop` of a recording of `size` samples, as shares of its length."""
    return Fraction(start, size), Fraction(stop, size)


def _within(found: NDArray[Any], span: Span) -> NDArray[Any]:
    """The numbers of a span of the recording, at least one; tables are taken whole."""
    if found.ndim != 1:
        return found
    first = min(int(span[0] * found.size), found.size - 1)
    return found[first : max(math.ceil(span[1] * found.size), first + 1)]

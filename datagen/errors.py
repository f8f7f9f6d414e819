"""One way to refuse what a person wrote: a message that names the file, the field, the value and what is allowed."""

from __future__ import annotations

from datetime import date, time

# Values within more tables or lists than this are not shown.
MOST_NESTED = 20


class BadInput(Exception):
    """Input that cannot be used; `str` gives one clear line, and a command ends with exit code 2.

    `file` is what was read (with the line if known), `field` the dotted name of the setting or the option, `value` what
    was found (None: nothing to show), `allowed` what would have been accepted, and `problem` a sentence for what these
    do not say.
    """

    def __init__(
        self, problem: str = "", *, file: str = "", field: str = "", value: object = None, allowed: str = ""
    ) -> None:
        super().__init__(problem)
        self.problem = problem
        self.file = file
        self.field = field
        self.value = value
        self.allowed = allowed

    def __str__(self) -> str:
        setting = setting_text(self.field, self.value)
        line = ": ".join(part for part in (self.file, setting, self.problem) if part)
        line += f"; allowed: {self.allowed}" if self.allowed else ""
        return " ".join(line.split())


def unreadable(path: object, problem: OSError, field: str = "") -> BadInput:
    """The refusal of a file that is not there, or that the system does not let be read, in its words."""
    if isinstance(problem, FileNotFoundError):
        return BadInput("no such file", file=str(path), field=field)
    return BadInput(f"cannot be read: {problem.strerror or problem}", file=str(path), field=field)


def at_line(file: object, line: int | None) -> str:
    """A file for a message, with the `line` in it where that is known (neither None nor 0)."""
    return f"{file}, line {line}" if line else str(file)


def setting_text(field: str, value: object) -> str:
    """A setting as TOML would have it, a long value cut short; the name alone where there is nothing to show (None)."""
    return field if value is None else f"{field} = {value_text(value)}"


def value_text(value: object) -> str:
    """A value as TOML would have it, a long one cut short."""
    text = _as_toml(value)
    return text if len(text) <= 120 else f"{text[:117]}..."


def _as_toml(value: object, depth: int = 0) -> str:
    if isinstance(value, dict | list | tuple) and depth > MOST_NESTED:
        return "..."
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {_as_toml(inner, depth + 1)}" for key, inner in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_as_toml(inner, depth + 1) for inner in value) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, date | time):
        return value.isoformat()
    return f'"{value}"' if isinstance(value, str) else repr(value)

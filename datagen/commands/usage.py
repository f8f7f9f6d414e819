"""Command lines that cannot be parsed: refused in one line with option, value and what is allowed, as any bad input.

If the reader of the output stops early, as `head` does, every command ends silently, with exit code 141.
"""

from __future__ import annotations

import os
import types
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Union, get_args, get_origin, get_type_hints

import typer
from typer.core import TyperGroup

from datagen.errors import BadInput
from datagen.exits import BAD_INPUT, OUTPUT_CLOSED, print_error
from physics.spelling import nearest

# What typer raises for any command line that it cannot parse; some of its versions bring their own click.
UNREADABLE: Any = typer.BadParameter.__mro__[1]
READABLE = "a file or folder that you may read"
KINDS = {int: "a whole number", float: "a number", Path: "a path", str: "a text"}


class Program(TyperGroup):
    """The group of all commands; a command line that cannot be parsed ends it with one line and exit code 2."""

    def make_context(self, info_name: str | None, args: list[str], *more: Any, **extra: Any) -> Any:
        """The context of a run with these `args`, which are kept for messages."""
        self._given = [str(part) for part in args]
        with self._guarded():
            _refuse_empty(self.commands.get(next(iter(self._given), "")), self._given)
            return super().make_context(info_name, args, *more, **extra)

    def invoke(self, ctx: Any) -> Any:
        """Run the command of the context."""
        with self._guarded():
            return super().invoke(ctx)

    @contextmanager
    def _guarded(self) -> Iterator[None]:
        """Turn what the block raises, on an unreadable command line or a closed output, into an exit code."""
        try:
            with self._readable():
                yield
        except BrokenPipeError:
            raise typer.Exit(OUTPUT_CLOSED) from None
        except OSError as problem:  # of help and version, as a command tells of its own
            print_error(f"the output: {problem.strerror}")
            raise typer.Exit(BAD_INPUT) from None

    @contextmanager
    def _readable(self) -> Iterator[None]:
        try:
            yield
        except UNREADABLE as problem:
            if type(problem).__name__ == "NoArgsIsHelpError":  # nothing is wrong, and the help is shown
                raise
            print_error(self._explained(problem))
            raise typer.Exit(BAD_INPUT) from None

    def _explained(self, problem: Any) -> BadInput:
        """What is wrong with the command line, as bad input."""
        context, parameter = problem.ctx, getattr(problem, "param", None)
        command = context.command if context is not None else self.commands.get(self._given[0], self)
        if parameter is not None:
            return _of_parameter(problem, command, parameter, self._given)
        if getattr(problem, "option_name", None):
            return _of_option(problem, command)
        if command is self:
            word = next((part for part in self._given if not part.startswith("-")), "")
            if not word:
                return BadInput("a command is missing", field="spallgen", allowed=", ".join(self.commands))
            said = f"there is no such command{_meant(nearest(word, self.commands))}"
            return BadInput(said, field=word, allowed=", ".join(self.commands))
        said = problem.format_message().rstrip(".")
        return BadInput(said[:1].lower() + said[1:], field=str(context.info_name), allowed=_usage(context))


def _refuse_empty(command: Any, given: Sequence[str]) -> None:
    """Refuse an empty argument or path among those `given`, such as "$OUT" with OUT unset: as a path it would be the
    current folder. `command` is None if there is no command of that name.

    Raises typer.Exit.
    """
    options = {name: parameter.name for parameter in getattr(command, "params", ()) for name in parameter.opts}
    for before, part in zip(("", *given), given, strict=False):
        name, equals, value = part.partition("=") if part.startswith("--") else (part, "", "")
        option = name if equals else before
        if value or (part and not equals) or (option.startswith("-") and not _is_path(command, options.get(option))):
            continue
        field = option if option.startswith("-") else "an argument"
        print_error(BadInput(field=field, value="", allowed="a value that is not empty"))
        raise typer.Exit(BAD_INPUT)


def _is_path(command: Any, name: str | None) -> bool:
    """Whether the parameter `name` of a command is a path."""
    return name is not None and Path in _kinds(_annotation(command, name)[0])


def _of_parameter(problem: Any, command: Any, parameter: Any, given: Sequence[str]) -> BadInput:
    """An option or argument whose value is missing or not allowed."""
    is_option = parameter.param_type_name == "option"
    word = parameter.metavar or parameter.name.upper()
    name = parameter.opts[0] if is_option else word
    if type(problem).__name__ == "MissingParameter":
        shown = f"{name} {word}" if is_option else word
        return BadInput("it must be given", field=name, allowed=f"{shown}: {parameter.help.rstrip('.')}")
    if _is_path(command, parameter.name):  # typer asks nothing of a path but that it may be read
        return BadInput("cannot be read for lack of permission", field=name, value=_locked(given), allowed=READABLE)
    return BadInput(field=name, value=_value(parameter.opts, given), allowed=_allowed(command, parameter.name))


def _locked(given: Sequence[str]) -> str | None:
    """The first file or folder among the words `given` after the command that may not be read; None if all may be."""
    words = (word for part in given[1:] for word in (part, part.partition("=")[2]))
    return next((word for word in words if os.path.exists(word) and not os.access(word, os.R_OK)), None)


def _of_option(problem: Any, command: Any) -> BadInput:
    """An option that does not exist, lacks its value or takes none."""
    if hasattr(problem, "possibilities"):
        names = [name for parameter in command.params for name in (*parameter.opts, *parameter.secondary_opts)]
        known = [name for name in names if name.startswith("--")]
        near = _meant(nearest(problem.option_name, known))
        allowed = ", ".join([*known, "--help"])
        return BadInput(f"there is no such option{near}", field=problem.option_name, allowed=allowed)
    parameter = next(known for known in command.params if problem.option_name in (*known.opts, *known.secondary_opts))
    if parameter.is_flag:
        return BadInput("this option takes no value", field=problem.option_name, allowed=problem.option_name)
    return BadInput(
        "the value of this option is missing", field=problem.option_name, allowed=_allowed(command, parameter.name)
    )


def _meant(known: str | None) -> str:
    return "" if known is None else f', did you mean "{known}"?'


def _usage(context: Any) -> str:
    """How the command of the context is written, in one line."""
    return str(context.command.get_usage(context)).removeprefix("Usage: ")


def _value(names: Sequence[str], given: Sequence[str]) -> str | None:
    """The last value given for the option of these `names`, as it was written; None if it is not found."""
    found = None
    for place, part in enumerate(given):
        name, equals, value = part.partition("=")
        if name in names:
            found = value if equals else next(iter(given[place + 1 :]), None)
    return found


def _allowed(command: Any, name: str) -> str:
    """What the parameter `name` of a command takes, in words, from its annotation."""
    kind, *notes = _annotation(command, name)
    plain = next((kind for kind in _kinds(kind) if kind in KINDS), str)
    note = next((note for note in notes if hasattr(note, "min")), None)
    low, high = (note.min, note.max) if note is not None else (None, None)
    if low is not None and high is not None:
        return f"{KINDS[plain]} from {low:g} to {high:g}"
    return KINDS[plain] + (f" from {low:g}" if low is not None else "")


def _annotation(command: Any, name: str) -> tuple[Any, ...]:
    """The type of the parameter `name` of a command, and the typer.Option that describes it."""
    return get_args(get_type_hints(command.callback, include_extras=True)[name])


def _kinds(kind: Any) -> tuple[Any, ...]:
    """The kinds that an annotation such as `list[int] | None` is made of."""
    if get_origin(kind) in (Union, types.UnionType, list):
        return tuple(inner for part in get_args(kind) for inner in _kinds(part))
    return (kind,)

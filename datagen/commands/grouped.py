"""Options of a command in groups: a parameter that is a dataclass stands for an option for each of its fields."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import is_dataclass
from inspect import Parameter
from typing import Annotated, Any, get_type_hints


def grouped(options: Mapping[str, Any]) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Decorator of a command with dataclasses among its parameters: on the command line each stands for one option per
    field, with the field's name and default, described by the typer.Option of that name in `options`.

    Raises KeyError for a field that has none there.
    """

    def decorate(function: Callable[..., None]) -> Callable[..., None]:
        hints = get_type_hints(function, include_extras=True)
        groups: dict[str, Any] = {name: kind for name, kind in hints.items() if is_dataclass(kind)}

        @functools.wraps(function)
        def flat(**given: Any) -> None:
            for name, kind in groups.items():
                given[name] = kind(**{field: given.pop(field) for field in inspect.signature(kind).parameters})
            function(**given)

        def flat_parameters() -> Iterator[Parameter]:
            for name, parameter in inspect.signature(function).parameters.items():
                kind = hints[name]
                if name not in groups:
                    yield parameter.replace(annotation=kind, kind=Parameter.KEYWORD_ONLY)
                    continue
                fields = get_type_hints(kind)
                for field, parameter in inspect.signature(kind).parameters.items():
                    yield parameter.replace(
                        annotation=Annotated[fields[field], options[field]], kind=Parameter.KEYWORD_ONLY
                    )

        parameters = list(flat_parameters())
        # typer reads the signature; the messages about unreadable command lines (`usage`) read the annotations.
        flat.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
        flat.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
        return flat

    return decorate

"""Reading a TOML file: whatever is wrong with it as text becomes one message that names it."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from datagen.errors import BadInput, unreadable

# What a float still holds; settings have ranges of their own, far below.
LARGEST_WHOLE = 10**300
RANGE = "whole numbers of up to 300 digits"


def read_toml(path: Path) -> tuple[dict[str, Any], str]:
    """What the file holds, and its text; raises BadInput."""
    try:
        text = path.read_text(encoding="utf-8-sig")
        content = tomllib.loads(text)
        largest = max(map(abs, _whole_numbers(content)), default=0)
        digits = len(str(largest))
    except OSError as error:
        raise unreadable(path, error) from None
    except UnicodeDecodeError:
        raise BadInput("not a UTF-8 text file", file=str(path)) from None
    except tomllib.TOMLDecodeError as error:
        raise BadInput(f"not valid TOML: {error}", file=str(path)) from None
    except RecursionError:
        raise BadInput("not valid TOML: nested too deeply", file=str(path)) from None
    except ValueError:  # a number of thousands of digits
        raise BadInput("a whole number in it has too many digits", file=str(path), allowed=RANGE) from None
    if largest >= LARGEST_WHOLE:
        raise BadInput(f"a whole number in it is too long: {digits} digits", file=str(path), allowed=RANGE)
    return content, text


def _whole_numbers(content: Any) -> Iterator[int]:
    if isinstance(content, int):
        yield content
    elif isinstance(content, dict | list):
        for part in content.values() if isinstance(content, dict) else content:
            yield from _whole_numbers(part)

"""Code that users bring to a command as "module:name": found, made and run with one message for whatever goes wrong."""

from __future__ import annotations

import importlib
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from datagen.errors import BadInput

FIELD = "--estimator"
OWN_CODE = Path(__file__).parents[1]


def load_user_code(name: str, allowed: str) -> Any:
    """The object called "module:name", also looked for in the working folder; a class is instantiated without
    arguments.

    Raises BadInput, which says what is `allowed`, whatever goes wrong on the way.
    """
    module, _, attribute = name.partition(":")
    if not module or not attribute:
        raise BadInput(field=FIELD, value=name, allowed=allowed)
    if "" not in sys.path:
        sys.path.insert(0, "")
    with user_code(name, "it cannot be loaded", allowed):
        found = getattr(importlib.import_module(module), attribute)
        return found() if isinstance(found, type) else found


@contextmanager
def user_code(name: str, problem: str, allowed: str = "") -> Iterator[None]:
    """Turn any exception that the user's code `name` raises in the block into BadInput that says where it happened."""
    try:
        yield
    except BadInput:
        raise
    except (Exception, SystemExit) as cause:
        text = f"{problem}: {type(cause).__name__}: {cause}{_place(cause)}"
        raise BadInput(text, field=FIELD, value=name, allowed=allowed) from cause


def _place(cause: BaseException) -> str:
    """File and line in which the `cause` was raised; empty inside Python, and where our own call failed, as for a class
    that wants arguments: neither is a place that its user could mend."""
    last = traceback.extract_tb(cause.__traceback__)[-1]
    if last.filename.startswith("<frozen ") or Path(last.filename).is_relative_to(OWN_CODE):
        return ""
    return f" ({last.filename}, line {last.lineno})"

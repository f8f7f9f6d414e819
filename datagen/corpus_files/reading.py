"""Reading a shard: whatever the libraries raise for a damaged file becomes one message that says how to repair it."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from datagen.errors import BadInput

AGAIN = "generate again into the same folder (a corpus of recordings: import it again)"
READ_ERRORS = (OSError, RuntimeError, ValueError, KeyError, IndexError, AttributeError)


def unencodable(path: Path) -> BadInput:
    """The error of a path that cannot be passed to the netCDF library in this locale's encoding."""
    problem = f"the encoding of this locale, {sys.getfilesystemencoding()}, lacks letters of this path"
    return BadInput(problem, file=str(path), allowed="a locale with UTF-8 (LC_ALL=C.UTF-8), or a path in ASCII")


@contextmanager
def reading(folder: Path, shard: str) -> Iterator[None]:
    """Turn whatever goes wrong in the block while `shard` (its name in the corpus `folder`) is read into BadInput."""
    try:
        yield
    except UnicodeEncodeError:
        raise unencodable(folder / shard) from None
    except PermissionError:
        raise BadInput(
            "this shard cannot be read for lack of permission; change its permissions", file=str(folder / shard)
        ) from None
    except FileNotFoundError:
        raise BadInput(f"this shard is missing: {AGAIN}", file=str(folder / shard)) from None
    except IndexError:
        raise BadInput(
            f"index.csv places a record beyond the end of this shard: run `spallgen check {folder}`, delete index.csv "
            f"and {AGAIN}",
            file=str(folder / shard),
        ) from None
    except READ_ERRORS as problem:
        raise BadInput(
            f"this shard cannot be read ({_cause(problem)}): run `spallgen check {folder}`, delete the file and "
            f"{AGAIN}",
            file=str(folder / shard),
        ) from None


def _cause(problem: Exception) -> str:
    text = getattr(problem, "strerror", None) or str(problem) or type(problem).__name__
    return str(text).splitlines()[0]

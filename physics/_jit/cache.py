"""Where compiled kernels lie: a folder named by the content of every physics source file.

numba notices edits in a cached function's own file only, so a kernel that calls into another file could go on serving
old physics. A cache folder per content hash cannot. It lies in SPALLGEN_CACHE, XDG_CACHE_HOME or ~/.cache, whichever is
there first.

Importing this has an effect on the whole process: numba keeps all of its caches in that folder from then on, those of
other people's kernels too. Where no such folder can be written, it is one of the process, deleted at its end, and
SPALLGEN_CACHE says so to the processes that this one starts.
"""

from __future__ import annotations

import atexit
import hashlib
import os
import shutil
import tempfile
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
import numba.core.caching


def fingerprint() -> str:
    """Hash of the text of every Python file of the physics package, 16 hexadecimal digits."""
    root = Path(__file__).parents[1]
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _cache_folder() -> Path:
    chosen = os.environ.get("SPALLGEN_CACHE") or os.environ.get("XDG_CACHE_HOME")
    try:
        folder = Path(chosen or Path.home() / ".cache") / "spallgen" / f"{fingerprint()}-numba{numba.__version__}"
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=folder):
            return folder
    except (OSError, RuntimeError):  # a user without a home, as in containers
        made = tempfile.mkdtemp(prefix="spallgen-cache-")
        atexit.register(shutil.rmtree, made, ignore_errors=True)
        os.environ["SPALLGEN_CACHE"] = made  # for the workers that this process starts
        return _cache_folder()


CACHE_FOLDER = _cache_folder()
# For all of numba, and before anything is decorated: a kernel of somebody else's that calls one of these would go on
# serving old physics from a folder of its own.
setattr(numba.config, "CACHE_DIR", str(CACHE_FOLDER))


def is_cached(kernel: Callable[..., Any]) -> bool:
    """Whether a `kernel` has been compiled, for whatever arguments; its folder is there as soon as it is defined."""
    return any(CACHE_FOLDER.rglob(f"*.{kernel.__name__}-*.nbi"))


def raised_by_cache(error: BaseException | None) -> bool:
    """Whether `error`, or one that led to it, arose while a compiled kernel was read back: what a cut file raises.

    A file that is missing, locked or does not fit on the disk is not damaged.
    """
    while error is not None and not isinstance(error, OSError):
        met = (frame.f_code.co_filename for frame, _ in traceback.walk_tb(error.__traceback__))
        if numba.core.caching.__file__ in met:
            return True
        error = error.__cause__ or error.__context__
    return False


def discard_cache() -> None:
    """Delete the compiled kernels: the cure for a cache file cut short by a crash."""
    shutil.rmtree(CACHE_FOLDER, ignore_errors=True)
    CACHE_FOLDER.mkdir(parents=True, exist_ok=True)

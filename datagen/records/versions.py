"""Versions of the programs whose numbers end up in a record."""

from __future__ import annotations

import hashlib
import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

PACKAGES = ("spallgen", "numpy", "scipy", "numba", "xarray", "netCDF4")


@cache
def program_hash() -> str:
    """Hash of the text of every Python file of `labels` and `datagen`, 16 hexadecimal digits."""
    root = Path(__file__).parents[2]
    digest = hashlib.sha256()
    for path in sorted(path for package in ("labels", "datagen") for path in (root / package).rglob("*.py")):
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def program_versions() -> dict[str, str]:
    """Version of Python and of each package, and the kind of machine."""
    packages = {package: _version(package) for package in PACKAGES}
    return {"python": platform.python_version(), "machine": f"{platform.system()} {platform.machine()}", **packages}


@cache
def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "source tree"

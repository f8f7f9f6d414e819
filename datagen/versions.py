"""Versions of the programs whose numbers end up in a record."""

from __future__ import annotations

import hashlib
import os
import platform
from collections.abc import Mapping
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

CPU_INFO = Path("/proc/cpuinfo")
PACKAGES = ("spallgen", "numpy", "scipy", "numba", "xarray", "netCDF4")
# The packages, each without those inside it, that draw, describe and store records, simulated or imported. A test
# follows the imports and asserts that none is missing; what draws pictures of records or judges them is not of these.
CORPUS_CODE = (
    "labels",
    "datagen",
    "datagen/corpus_files",
    "datagen/distributions",
    "datagen/files",
    "datagen/formats",
    "datagen/recipes",
    "datagen/recordings",
    "datagen/records",
    "datagen/runs",
    "datagen/scenarios",
    "datagen/settings",
)
MACHINE_FACTS = ("machine", "processor", "cores", "physics")


@cache
def program_hash(*packages: str) -> str:
    """Hash of the text of every Python file of the `packages`, each without those inside it, CORPUS_CODE if none is
    named: 16 hexadecimal digits."""
    root = Path(__file__).parents[1]
    digest = hashlib.sha256()
    for path in sorted(path for package in packages or CORPUS_CODE for path in (root / package).glob("*.py")):
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def program_versions() -> dict[str, str]:
    """Version of Python and of each package, and the kind of machine."""
    packages = {package: _version(package) for package in PACKAGES}
    return {"python": platform.python_version(), "machine": f"{platform.system()} {platform.machine()}", **packages}


def measured_on(*packages: str) -> dict[str, str]:
    """What a measured speed belongs to: machine, processor, cores, physics (its fingerprint), Python and `packages`."""
    from physics.compiled import fingerprint

    return {
        "machine": f"{platform.system()} {platform.machine()}",
        "processor": processor_name(),
        "cores": str(os.cpu_count() or "unknown"),
        "physics": fingerprint(),
        "python": platform.python_version(),
        **{package: _version(package) for package in packages},
    }


def in_words(made: Mapping[str, str]) -> str:
    """What `measured_on` gives in one line for people."""
    packages = ", ".join(f"{name} {value}" for name, value in made.items() if name not in MACHINE_FACTS)
    return f"{made['processor']}, {made['cores']} cores, {made['machine']}, physics {made['physics']}, {packages}"


def processor_name() -> str:
    """The processor's model name; its kind alone where the system says no more."""
    try:
        lines = CPU_INFO.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        lines = []
    names = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next((name for name in names if name), "") or platform.processor() or platform.machine()


@cache
def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "source tree"

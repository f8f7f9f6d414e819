"""Results as plain data, and as JSON text, for other programs."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Mapping
from typing import Any


def plain_json(result: Any) -> str:
    """JSON text of dataclasses, mappings, sequences, arrays, numbers; NaN and infinities, which it lacks, are null."""
    return json.dumps(plain(result), indent=1, allow_nan=False) + "\n"


def plain(value: Any) -> Any:
    """The same as what JSON knows: dictionaries, lists, numbers, None for NaN and infinities; all else as it is."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {f.name: plain(getattr(value, f.name)) for f in dataclasses.fields(value)}
    if isinstance(value, Mapping):
        return {str(key): plain(held) for key, held in value.items()}
    if isinstance(value, list | tuple):
        return [plain(held) for held in value]
    if hasattr(value, "tolist"):  # of NumPy
        return plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value

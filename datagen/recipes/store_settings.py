"""What of a record is written, and how."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from datagen.files.netcdf import COMPRESSIONS, NO_LZ4, Compression
from datagen.settings.table import Table, refuse


def _not_lz4(compression: object) -> object:
    """The compression; raises PydanticCustomError that says why one that readers may expect is not offered."""
    if compression == "lz4":
        raise refuse(NO_LZ4, allowed=", ".join(COMPRESSIONS))
    return compression


class Store(Table):
    """What is written and how."""

    compression: Annotated[Compression, BeforeValidator(_not_lz4)] = "zlib"
    """Compression of the shards."""
    records_per_shard: Annotated[int, Field(ge=1, le=1_000_000)] = 32
    """Most records in one shard."""
    clean: bool = False
    """Store the acceleration without sensor path and background too."""
    sensor: bool = False
    """Store the acceleration after sensor path and mounting, without background, too."""
    background: bool = False
    """Store every layer of the background too."""
    cage_angle: bool = False
    """Store the cage angle too."""
    profile: bool = False
    """Store the path of the ball's centre over the defective race too."""
    contact_force: Literal["none", "first_of_each", "all"] = "none"
    """Store the force of every ball too: of no record, of the first of each rig and condition, or of all."""

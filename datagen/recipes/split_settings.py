"""How the virtual machines of a corpus are divided into splits."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from datagen.settings.table import Table, refuse


class Split(Table):
    """Shares of the virtual machines in each split; never divides the records of one machine."""

    train: Annotated[float, Field(ge=0.0, le=1.0)] = 0.7
    """Share for training."""
    validation: Annotated[float, Field(ge=0.0, le=1.0)] = 0.15
    """Share for choosing between models."""
    test: Annotated[float, Field(ge=0.0, le=1.0)] = 0.15
    """Share for the final score."""

    @model_validator(mode="after")
    def _whole(self) -> Split:
        total = self.train + self.validation + self.test
        if abs(total - 1.0) > 1e-9:
            shares = {name: getattr(self, name) for name in type(self).model_fields}
            said = (f"{name} = {share:g}{self._origin(name)}" for name, share in shares.items())
            first = next(name for name in shares if name in self.model_fields_set)
            raise refuse(f"{', '.join(said)} add up to {total:g}", first, "three shares that add up to 1")
        return self

    def _origin(self, name: str) -> str:
        return "" if name in self.model_fields_set else " (its default)"

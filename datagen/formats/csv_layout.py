"""How a text table is laid out, as SPECs and recipes say it."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, field_validator, model_validator
from pydantic_core import PydanticCustomError

from datagen.files.csv_rows import UTF_8
from datagen.files.number_texts import number
from datagen.settings.table import Table, refuse

ONE_CHARACTER = 'one character, such as ";", or "\\t" for a tabulator'
MOST_SKIPPED = 1_000_000_000
ENCODINGS = "an encoding of texts, such as utf-8, latin-1 or utf-16"


class CsvLayout(Table):
    """How a text table is laid out."""

    delimiter: Annotated[str, Field(min_length=1, max_length=1)] = ","
    """Character between cells; a space stands for any run of blanks."""
    decimal: Annotated[str, Field(min_length=1, max_length=1)] = "."
    """Decimal sign."""
    header: bool = True
    """True if a line of column names comes first; without it the columns are called "1", "2", …"""
    skip_lines: Annotated[int, Field(ge=0, le=MOST_SKIPPED)] = 0
    """Lines to leave out at the start."""
    skip_below: Annotated[int, Field(ge=0, le=MOST_SKIPPED)] = 0
    """Lines to leave out below that of column names, such as one of units; blank ones do not count."""
    encoding: str = UTF_8
    """Encoding of the text, as Python calls it: utf-8, latin-1, utf-16, …"""

    @model_validator(mode="after")
    def _delimiter_can_delimit(self) -> CsvLayout:
        if self.delimiter in '"\r\n':
            raise refuse(
                "this character is reserved for quotes or line ends",
                "delimiter",
                'a character that is neither " nor a line end',
            )
        if self.delimiter == self.decimal:
            raise refuse(
                "decimal sign and delimiter are the same", "delimiter", "a character other than the one in decimal"
            )
        return self

    @model_validator(mode="after")
    def _below_is_below_a_header(self) -> CsvLayout:
        if self.skip_below and not self.header:
            raise refuse("there is no header to be below; skip_lines leaves out lines at the start", "skip_below", "0")
        return self

    @property
    def head_rows(self) -> int:
        """Rows above the numbers that are not among `skip_lines`."""
        return int(self.header) + self.skip_below

    def number(self, cell: str) -> float:
        """The number in a `cell`, with this decimal sign or a point; NaN if it holds none."""
        return number(cell.replace(self.decimal, "."))

    @field_validator("delimiter", "decimal", mode="before")
    @classmethod
    def _is_one_character(cls, sign: Any) -> Any:
        if isinstance(sign, str) and len(sign) != 1:
            raise PydanticCustomError("allowed", "allowed: {allowed}", {"allowed": ONE_CHARACTER})
        return sign

    @field_validator("encoding")
    @classmethod
    def _encoding_is_known(cls, encoding: str) -> str:
        try:
            "".encode(encoding)
        except (LookupError, ValueError):
            raise PydanticCustomError("allowed", "allowed: {allowed}", {"allowed": ENCODINGS}) from None
        return encoding

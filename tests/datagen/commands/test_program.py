"""How commands print their results."""

import pytest
from rich.table import Table

from datagen.commands.program import show_tables

# Opening and closing tags of rich, one that nothing opens, and a picture of its.
TEXT = "[red]dry[/red] [/] :boom:"


def test_texts_of_a_table_are_printed_as_they_stand(capsys: pytest.CaptureFixture[str]) -> None:
    table = Table(TEXT, title=f"title {TEXT}")
    table.add_row(f"cell {TEXT}")
    show_tables([table])
    printed = capsys.readouterr().out
    assert printed.count(TEXT) == 3

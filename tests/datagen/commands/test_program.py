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


def test_without_a_terminal_names_are_printed_whole(capsys: pytest.CaptureFixture[str]) -> None:
    name = "Learning_set/Bearing1_1/acc_00001 horizontal " * 4 + "x" * 150
    table = Table("record", "recording", "why")
    table.add_row("1", name, "no ball passes stand out of the record " * 5)
    show_tables([table])
    printed = capsys.readouterr().out
    assert name in printed
    assert "record" in printed

"""How commands print their results, and how they end where something stops them."""

import errno

import pytest
from command_line import run
from rich.table import Table

from datagen.commands.program import show_tables
from datagen.commands.termination import Terminated
from datagen.inspection import info
from physics.outcome import Outcome, SimulationFailed

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


@pytest.mark.parametrize(
    ("stop", "code", "said"),
    [
        (Terminated(), 143, "interrupted; what had not been written is lost"),
        (KeyboardInterrupt(), 130, "interrupted; what had not been written is lost"),
        (SimulationFailed(Outcome.TOO_MANY_STEPS, "too many steps"), 1, "this cannot be simulated: too many steps"),
        (PermissionError(errno.EACCES, "Permission denied", "a.nc"), 2, "a.nc: Permission denied; allowed: a path"),
        (OSError(errno.ENOSPC, "No space left", "a.nc"), 2, "a.nc: No space left"),
        (OSError(errno.EXDEV, "Other device", "a.nc.tmp", None, "a.nc"), 2, "error: a.nc: Other device"),
        (OSError(errno.ENOSPC, "No space left"), 2, "the output: No space left"),
    ],
)
def test_what_stops_a_command_is_told_in_one_sentence(stop, code, said, monkeypatch, tmp_path):
    def stopped(folder):
        raise stop

    monkeypatch.setattr(info, "corpus_info", stopped)
    ended = run("info", tmp_path)
    assert ended.exit_code == code
    assert said in ended.stderr
    assert ended.stderr.count("\n") == 1

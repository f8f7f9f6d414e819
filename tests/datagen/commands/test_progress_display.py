"""How progress is shown."""

import io

import pytest
from rich.console import Console
from rich.progress import Progress

from datagen.commands.progress_display import CLEARED, Bar, Lines, show_steps


def test_progress_is_plain_lines_where_it_is_piped(capsys):
    clock = iter([0.0, 1.0, 2.5])
    with show_steps(lambda: next(clock)) as listener:
        for step in ("1 of 3: a", "2 of 3: b", "3 of 3: c"):
            listener.step(step)
    assert capsys.readouterr().err == "1 of 3: a\n3 of 3: c\n"


def test_on_a_terminal_a_sentence_that_stays_takes_the_changing_line_away_first(capfd, monkeypatch):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    with show_steps() as listener:
        listener.step("1 of 2")
        listener.say("half of it")
        assert capfd.readouterr() == ("half of it\n", f"{CLEARED}1 of 2{CLEARED}")
        listener.step("2 of 2")
    assert capfd.readouterr() == ("", f"{CLEARED}2 of 2{CLEARED}")


def test_the_pace_of_a_run_that_goes_on_is_that_of_its_own_records(capsys):
    clock = iter([0.0, 10.0])
    lines = Lines(lambda: next(clock))
    lines.advance(100, 200)
    lines.advance(120, 200)  # 20 in 10 s, and 80 are left
    assert capsys.readouterr().err == "100 of 200 records\n120 of 200 records, 2.00 records/s, 40 s left\n"


def test_the_last_record_is_told_however_soon_it_comes(capsys):
    clock = iter([0.0, 0.5, 1.0])
    lines = Lines(lambda: next(clock))
    for done in (0, 1, 2):
        lines.advance(done, 2)
    assert capsys.readouterr().err == "0 of 2 records\n2 of 2 records, 2.00 records/s, 0 s left\n"


def test_the_bar_of_a_run_that_goes_on_shows_the_pace_of_its_own_records_from_the_first_on():
    clock = [0.0]
    progress = Progress(console=Console(file=io.StringIO()), auto_refresh=False, get_time=lambda: clock[-1])
    bar = Bar(progress)
    shown = []
    for seconds, done in ((0.0, 100), (10.0, 120), (20.0, 140)):
        clock.append(seconds)
        bar.advance(done, 200)
        shown.append((progress.tasks[0].completed, progress.tasks[0].speed))
    assert shown == [(100, None), (120, pytest.approx(2.0)), (140, pytest.approx(2.0))]

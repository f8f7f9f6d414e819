"""SIGTERM as an exception."""

import signal

import pytest

from datagen.commands import termination
from datagen.commands.termination import TOGETHER, Terminated, terminable


@pytest.fixture
def at(monkeypatch):
    """Sets the time (s) at which the next signal comes."""
    return lambda seconds: monkeypatch.setattr(termination.time, "monotonic", lambda: seconds)


class Dropping:
    """Whatever is raised while it is finalised is dropped."""

    def __del__(self):
        signal.raise_signal(signal.SIGTERM)


def test_signals_that_come_together_with_one_do_not_interrupt_what_tidies_up(at):
    tidied = []

    def work():
        at(0.0)
        try:
            signal.raise_signal(signal.SIGTERM)
        finally:
            at(0.9 * TOGETHER)
            signal.raise_signal(signal.SIGTERM)
            tidied.append(True)

    with pytest.raises(Terminated), terminable():
        work()
    assert tidied


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_where_the_first_signal_was_dropped_a_later_one_ends_the_block(at):
    def work():
        at(0.0)
        Dropping()
        at(1.1 * TOGETHER)
        signal.raise_signal(signal.SIGTERM)

    with pytest.raises(Terminated), terminable():
        work()


def test_a_handler_of_somebody_else_stays_and_ours_goes_with_the_block():
    with terminable():
        ours = signal.getsignal(signal.SIGTERM)
        with terminable():
            assert signal.getsignal(signal.SIGTERM) is ours
    assert signal.getsignal(signal.SIGTERM) == signal.SIG_DFL

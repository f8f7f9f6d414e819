"""How a command ends where something stops it: one sentence and the exit code that belongs to it."""

import errno

import pytest
from command_line import run

from datagen.commands.termination import Terminated
from datagen.inspection import info
from physics.outcome import Outcome, SimulationFailed


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

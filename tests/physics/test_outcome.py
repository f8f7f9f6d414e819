"""Outcomes: sentences with remedies, and an exception that survives the way back from a worker process."""

import pickle

import pytest

from physics.outcome import Outcome, SimulationFailed, StaticOutcome


@pytest.mark.parametrize("outcome", [*StaticOutcome, *Outcome])
def test_every_outcome_is_a_sentence_of_its_own(outcome):
    assert len(outcome.value.split()) >= 5
    assert not outcome.value.endswith(".")
    assert type(outcome)(outcome.value) is outcome


def test_a_failure_tells_what_happened_and_what_to_change():
    failure = SimulationFailed(Outcome.NOT_FINITE, "the response stopped being finite with steps of 1e-05 s")
    assert failure.outcome is Outcome.NOT_FINITE
    assert str(failure) == f"the response stopped being finite with steps of 1e-05 s; {Outcome.NOT_FINITE.value}"


def test_a_failure_is_the_same_after_a_worker_sent_it_back():
    failure = SimulationFailed(Outcome.NO_START, "no position carries 346 N")
    received = pickle.loads(pickle.dumps(failure))
    assert type(received) is SimulationFailed
    assert received.outcome is Outcome.NO_START
    assert str(received) == str(failure)

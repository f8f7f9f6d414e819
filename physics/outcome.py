"""How a calculation can end: a closed list of outcomes, each with its remedy."""

from __future__ import annotations

from enum import Enum


class StaticOutcome(Enum):
    """How the search for a quasi-static equilibrium ended; the value is a sentence."""

    LOADED = "the load is carried and the equilibrium is unique"
    NOT_UNIQUE = "the load is carried but the stiffness is singular: the shaft can move without changing any load"
    NOT_LOADED = "no load, so no ball is pressed and every position inside the clearance is an equilibrium"
    NO_EQUILIBRIUM = "no position of the shaft carries the load"


class Outcome(Enum):
    """Why a simulation could not be completed; the value is the remedy."""

    NO_START = "give a load that the bearing can carry, or fewer or smaller gaps in the loaded race"
    NOT_FINITE = "use a shorter step (more substeps), or check masses, stiffness and damping for extreme values"
    TOO_MANY_CHANGES = "use the no-tension contact law, more film damping or a shorter step"
    UNSTABLE_STEP = "use a shorter step (more substeps), or a method that this mode does not limit"
    INACCURATE = "ask for less accuracy, or let the modal method choose its own steps"
    UNRESOLVED = "raise the sampling rate, or give the resonator more mass or less stiffness"
    TOO_MANY_STEPS = (
        "ask for less accuracy, check damping, masses and stiffness for extreme values, or in place of an explicit "
        "method take an implicit or exponential one, whose step stiffness does not limit"
    )
    BAD_REQUEST = "correct the argument named in the message"


class SimulationFailed(RuntimeError):
    """A simulation that could not be completed; `outcome` names the reason, and its remedy ends the message."""

    def __init__(self, outcome: Outcome, message: str) -> None:
        super().__init__(f"{message}; {outcome.value}")
        self.outcome = outcome
        self._message = message

    def __reduce__(self) -> tuple[type[SimulationFailed], tuple[Outcome, str]]:
        """What a worker process sends back: an exception is otherwise remade from its text alone."""
        return type(self), (self.outcome, self._message)

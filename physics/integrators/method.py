"""What every numerical method states of itself: the contract that tests check and that chart and documents print."""

from __future__ import annotations

from dataclasses import dataclass

ALL_MODES, CONTACT_MODES, NO_MODES = "every mode", "the contact modes", "none"


@dataclass(frozen=True)
class Method:
    """One method and its contract.

    `order` of the global error where the contact set does not change; `contact_sums` per step; `stability_limit`, the
    largest ω h (rad) of an undamped mode, infinite if there is none, and which modes it `limits`; where samples come
    from (`dense_output`), what is done about contact changes and kinks (`events`), and what the method is for.
    """

    name: str
    title: str
    order: float
    contact_sums: float
    stability_limit: float
    limits: str
    dense_output: str
    events: str
    purpose: str
    source: str

"""What every numerical method states of itself: the contract that tests check and that chart and documents print."""

from __future__ import annotations

from dataclasses import dataclass

ALL_MODES, CONTACT_MODES, NO_MODES = "every mode", "the contact modes", "none"


@dataclass(frozen=True)
class Method:
    """One method and its contract.

    `order` of the global error where the contact set does not change; `contact_sums` per step; where samples come
    from (`dense_output`), what is done about contact changes and kinks (`events`), and what the method is for.

    `stability_limit`: the largest |λ| h of an undamped mode, infinite if every step is stable, NaN for a method that
    `controls_step`: it shortens its own steps until they are stable, and no limit is stated. `damped_limits`: pairs of
    a damping ratio and the largest |λ| h from that ratio on, in rising order; for what lies below the first,
    `stability_limit` holds. `limits` says which modes are meant.
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
    damped_limits: tuple[tuple[float, float], ...] = ()
    controls_step: bool = False

    def limit_at(self, damping: float) -> float:
        """The largest |λ| h of a mode with this damping ratio: −Re λ / |λ|, 1 for one that does not swing."""
        limit = self.stability_limit
        for least, damped in self.damped_limits:
            if damping >= least:
                limit = damped
        return limit

"""What the contact force differs from the spring and damper that stand for it in the modes."""

from __future__ import annotations

from physics._jit import njit_inline, njit_inner
from physics.arrays import Array
from physics.contact.forces import Contacts, press
from physics.integrators.modal.flow import LinearFlow, Motion, relative


@njit_inline
def remainder_at(contacts: Contacts, flow: LinearFlow, motion: Motion) -> tuple[float, float]:
    """The remaining contact force (N) along x and y at a relative `motion`; leaves `contacts` as `press` does."""
    x, y, u, v = motion
    fx, fy = press(contacts, x, y, u, v)
    return fx - flow.stiffness[0] * x - flow.damping[0] * u, fy - flow.stiffness[1] * y - flow.damping[1] * v


@njit_inner
def remaining_force(contacts: Contacts, flow: LinearFlow, state: Array, rest: Array) -> tuple[float, float]:
    """The remaining contact force (N) along x and y of the amplitudes `state` (12,)."""
    return remainder_at(contacts, flow, relative(flow, state, rest))

"""How the net contact force changes with the displacement, for methods that solve for the force [P14 Eq. 26, 27]."""

from __future__ import annotations

from physics._jit import njit
from physics.contact.forces import ACTIVE, COMPRESSION, FRAME_SPEED, Contacts, direction, law_power


@njit
def contact_tangent(contacts: Contacts, rate: float) -> tuple[float, float, float, float]:
    """Derivatives (xx, xy, yx, yy), N/m, of the net force of the contact set to the displacement.

    The velocity is taken to grow by `rate` (1/s) times the displacement. `press` must have been called.
    """
    balls, law = contacts.balls, contacts.law
    xx, xy, yx, yy = 0.0, 0.0, 0.0, 0.0
    for cage in range(balls.shape[0]):
        across = law.damping * contacts.frames[cage, FRAME_SPEED]
        for j in range(balls.shape[2]):
            if balls[cage, ACTIVE, j] > 0.5:
                c, s = direction(contacts, cage, j)
                power = law_power(law, balls[cage, COMPRESSION, j])
                along = law.exponent * law.stiffness * power + law.damping * rate
                to_x, to_y = along * c - across * s, along * s + across * c
                xx += c * to_x
                xy += c * to_y
                yx += s * to_x
                yy += s * to_y
    return xx, xy, yx, yy

"""How the net contact force changes with the displacement, for methods that solve for the force [P14 Eq. 26, 27]."""

from __future__ import annotations

from physics._jit import njit
from physics.contact.forces import (
    ACTIVE,
    COMPRESSION,
    COSINE,
    FRAME_COSINE,
    FRAME_SINE,
    FRAME_SPEED,
    SINE,
    Contacts,
    law_power,
)


@njit
def contact_tangent(contacts: Contacts, rate: float) -> tuple[float, float, float, float]:
    """Derivatives (xx, xy, yx, yy), N/m, of the net force of the contact set to the displacement.

    The velocity is taken to grow by `rate` (1/s) times the displacement. `press` must have been called.
    """
    balls, frames, law = contacts.balls, contacts.frames, contacts.law
    xx, xy, yx, yy = 0.0, 0.0, 0.0, 0.0
    for cage in range(balls.shape[0]):
        cosine, sine, speed = frames[cage, FRAME_COSINE], frames[cage, FRAME_SINE], frames[cage, FRAME_SPEED]
        for j in range(balls.shape[2]):
            if balls[cage, ACTIVE, j] > 0.5:
                c = balls[cage, COSINE, j] * cosine - balls[cage, SINE, j] * sine
                s = balls[cage, SINE, j] * cosine + balls[cage, COSINE, j] * sine
                power = law_power(law, balls[cage, COMPRESSION, j])
                along = law.exponent * law.stiffness * power + law.damping * rate
                across = law.damping * speed
                to_x, to_y = along * c - across * s, along * s + across * c
                xx += c * to_x
                xy += c * to_y
                yx += s * to_x
                yy += s * to_y
    return xx, xy, yx, yy

"""The table of numerical methods: what each is, what it costs, where it stops being stable and what it is for."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import NamedTuple

from physics.integrators.dormand_prince_march import march_dormand_prince
from physics.integrators.exponential_adams import ORDERS, march_of_order
from physics.integrators.exponential_rk4 import march_exponential_rk4
from physics.integrators.generalised_alpha import march_generalised_alpha
from physics.integrators.method import ALL_MODES, CONTACT_MODES, NO_MODES, Method
from physics.integrators.runge_kutta4 import march_runge_kutta4

REFERENCE, MODAL = "reference", "modal"
MARCHES: Mapping[str, Callable[..., int]] = {
    "exponential_rk4": march_exponential_rk4,
    "runge_kutta4": march_runge_kutta4,
    "dormand_prince": march_dormand_prince,
    "generalised_alpha": march_generalised_alpha,
    **{f"exponential_adams{order}": march_of_order(order) for order in ORDERS},
}


class Limits(NamedTuple):
    """The largest |λ| h of an undamped mode, and from each damping ratio on, as `Method` has them."""

    undamped: float
    damped: tuple[tuple[float, float], ...]


# Where the largest eigenvalue of the method's amplification matrix over one step reaches 1, or a little below; these
# matrices are in tests/physics/integrators/test_stability_limits.py. Limits rise with a little damping and fall again
# towards the aperiodic case. An undamped mode under the Adams methods of order 3 and 4 grows at any step; up to their
# limit by less than 1 % in 65 536 steps.
RK4_EXPONENTIAL = Limits(1.41, ((0.9, 1.33),))
RK4_CLASSICAL = Limits(2.82, ((0.3, 2.59), (0.9, 2.78)))
ADAMS = {
    2: Limits(1.83, ((0.2, 1.36), (0.5, 0.87))),
    3: Limits(0.05, ((1e-5, 0.075), (1e-4, 0.16), (3e-4, 0.235), (1e-3, 0.34), (1e-2, 0.7), (3e-2, 0.78))),
    4: Limits(0.15, ((1e-5, 0.235), (1e-4, 0.36), (3e-4, 0.44), (1e-3, 0.55), (3e-3, 0.61))),
}
_LOCATED = "every contact change located on the quintic through the step's ends; stops at every known kink"

METHODS: Mapping[str, Method] = {
    method.name: method
    for method in (
        Method(
            name=MODAL,
            title="exponential predictor-corrector on all modes, order 5, own steps",
            order=5.0,
            contact_sums=2.0,
            stability_limit=math.nan,
            controls_step=True,
            limits=NO_MODES,
            dense_output="the modes' exact response to the quartic through the forces of this step and the one before",
            events="located as exactly as the jump of force asks, steps graded as far as the speed of contact asks; "
            "stops at every known kink",
            purpose="the default: steps of up to twenty-four samples, as long as the accuracy allows",
            source="multistep: Hochbruck and Ostermann 2010, Acta Numerica 19, 209; first steps: Krogstad 2005, "
            "J. Comput. Phys. 203, 72; step control and modes of our own",
        ),
        Method(
            name="exponential_rk4",
            title="exponential Runge-Kutta, order 4",
            order=4.0,
            contact_sums=4.0,
            stability_limit=RK4_EXPONENTIAL.undamped,
            damped_limits=RK4_EXPONENTIAL.damped,
            limits=CONTACT_MODES,
            dense_output="steps end on samples",
            events=_LOCATED,
            purpose="the resonator is solved exactly, so a sample of 65 536 Hz needs one step",
            source="Krogstad 2005, J. Comput. Phys. 203, 72",
        ),
        *(
            Method(
                name=f"exponential_adams{order}",
                title=f"exponential Adams predictor-corrector, order {order}",
                order=float(order),
                contact_sums=2.0,
                stability_limit=ADAMS[order].undamped,
                damped_limits=ADAMS[order].damped,
                limits=CONTACT_MODES,
                dense_output="steps end on samples",
                events=f"{_LOCATED}; restarts after each with exponential Runge-Kutta steps",
                purpose="few contact sums a step where contact changes are rare",
                source="Hochbruck and Ostermann 2011, BIT Numer. Math. 51, 889",
            )
            for order in ORDERS
        ),
        Method(
            name="runge_kutta4",
            title="classical Runge-Kutta, order 4",
            order=4.0,
            contact_sums=4.0,
            stability_limit=RK4_CLASSICAL.undamped,
            damped_limits=RK4_CLASSICAL.damped,
            limits=ALL_MODES,
            dense_output="steps end on samples",
            events=_LOCATED,
            purpose="the textbook method, for comparison",
            source="Kutta 1901",
        ),
        Method(
            name="dormand_prince",
            title="Dormand-Prince 5(4), own steps",
            order=5.0,
            contact_sums=7.0,
            stability_limit=math.nan,
            controls_step=True,
            limits=NO_MODES,
            dense_output="order 4 (Shampine 1986)",
            events=_LOCATED,
            purpose="scenes of unknown stiffness: its step control shortens steps as far as accuracy and stability ask",
            source="Dormand and Prince 1980, J. Comput. Appl. Math. 6, 19",
        ),
        Method(
            name="generalised_alpha",
            title="generalised-α, order 2, ρ∞ = 0.9",
            order=2.0,
            contact_sums=5.0,
            stability_limit=math.inf,
            limits=NO_MODES,
            dense_output="steps end on samples",
            events=_LOCATED,
            purpose="stiff scenes whose fastest modes need not be resolved",
            source="Chung and Hulbert 1993, J. Appl. Mech. 60, 371",
        ),
        Method(
            name=REFERENCE,
            title="DOP853, order 8, relative tolerance 1e-9",
            order=8.0,
            contact_sums=12.0,
            stability_limit=math.nan,
            controls_step=True,
            limits=NO_MODES,
            dense_output="order 7",
            events="every contact change bisected on the dense output; a tiny straight step over every known kink",
            purpose="the slow answer that others are held against; shares no kernel with them",
            source="Hairer, Nørsett and Wanner 1993, Solving Ordinary Differential Equations I",
        ),
    )
}

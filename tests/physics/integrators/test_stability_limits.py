"""The stability limits that methods state, against their amplification matrices over one step of a single mode."""

import math

import numpy as np
import pytest

from physics.integrators.method_table import METHODS

# Damping ratios from undamped to far beyond aperiodic, close together where limits change fast.
DAMPING = (0.0, 1e-7, 1e-6, *np.geomspace(1e-5, 0.3, 200), *np.linspace(0.3, 1.5, 121), 2.0, 3.0, 10.0, 100.0)
STEPS_A_SECOND = 65536


def stages_adams(order):
    """One step (x, v, three past forces) of the exponential Adams method of this order [Hochbruck and Ostermann 2011].

    Of a free mass of 1 kg with steps of 1 s, on which the force f(x, v) is known through its values at steps alone.
    """

    def step(state, force):
        x, v, *past = state
        now = force(x, v)
        known = [now, *past]
        x_ahead, v_ahead = moved(x, v, np.polyfit(-np.arange(order), known[:order], order - 1))
        values = [force(x_ahead, v_ahead), *known[: order - 1]]
        return [*moved(x, v, np.polyfit(1 - np.arange(order), values, order - 1)), now, *past[:2]]

    return step, 5


def moved(x, v, polynomial):
    """A free mass of 1 kg after 1 s under a polynomial force."""
    speed = np.polyint(polynomial, k=v)
    return np.polyval(np.polyint(speed, k=x), 1.0), np.polyval(speed, 1.0)


def step_exponential_rk4(state, force):
    """Krogstad's method, whose linear part is a free mass."""
    x, v = state
    one = force(x, v)
    two = force(x + 0.5 * v + one / 8.0, v + one / 2.0)
    three = force(x + 0.5 * v + (one + 2.0 * two) / 24.0, v + two / 2.0)
    four = force(x + v + (one + 2.0 * three) / 6.0, v + three)
    return [x + v + (one + two + three) / 6.0, v + (one + 2.0 * two + 2.0 * three + four) / 6.0]


def step_runge_kutta4(state, force):
    def rate(y):
        return np.array([y[1], force(*y)])

    y = np.array(state)
    one = rate(y)
    two = rate(y + one / 2.0)
    three = rate(y + two / 2.0)
    return list(y + (one + 2.0 * two + 2.0 * three + rate(y + three)) / 6.0)


STEPS = {
    "exponential_rk4": (step_exponential_rk4, 2),
    "runge_kutta4": (step_runge_kutta4, 2),
    **{f"exponential_adams{order}": stages_adams(order) for order in (2, 3, 4)},
}
LIMITED = [name for name, method in METHODS.items() if math.isfinite(method.stability_limit)]


def growth(name, turn, damping):
    """Largest factor a step of a mode whose fastest eigenvalue has |λ| h = `turn`."""
    step, size = STEPS[name]
    angle = turn / (damping + math.sqrt(damping**2 - 1.0)) if damping > 1.0 else turn
    columns = [step(list(unit), lambda x, v: -(angle**2) * x - 2.0 * damping * angle * v) for unit in np.eye(size)]
    return np.abs(np.linalg.eigvals(np.array(columns).T)).max()


def test_every_limited_method_has_its_matrix_here():
    assert set(LIMITED) == set(STEPS)


@pytest.mark.parametrize("name", LIMITED)
def test_no_decaying_mode_grows_within_the_stated_limit(name):
    for damping in DAMPING:
        # Undamped, or nearly, an Adams method of order 3 or 4 may grow by 1 % in so many steps; else round-off.
        allowed = 0.01 / STEPS_A_SECOND if damping < 1e-5 else 1e-12
        limit = METHODS[name].limit_at(min(damping, 1.0))
        assert all(growth(name, share * limit, damping) <= 1.0 + allowed for share in (0.25, 0.5, 0.75, 0.9, 1.0))


@pytest.mark.parametrize("name", LIMITED)
def test_the_limits_are_not_far_too_careful(name):
    """At 2.2 times the limit of every damping ratio that has one, a mode of this damping grows."""
    for damping in (0.0, *(least for least, _ in METHODS[name].damped_limits)):
        assert growth(name, 2.2 * METHODS[name].limit_at(damping), damping) > 1.0 + 1e-9


def test_a_limit_holds_from_its_damping_ratio_up_to_the_next():
    method = METHODS["runge_kutta4"]
    assert [method.limit_at(damping) for damping in (-0.1, 0.0, 0.29, 0.3, 0.9, 1.0)] == [
        2.82, 2.82, 2.82, 2.59, 2.78, 2.78
    ]  # fmt: skip

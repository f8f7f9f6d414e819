"""How seldom progress is reported."""

from datagen.progress import Throttle


def test_what_is_throttled_is_due_at_once_and_then_when_its_time_has_passed() -> None:
    throttle = Throttle(2.0)
    assert [throttle.due(now) for now in (5.0, 6.9, 7.0, 8.9, 20.0, 21.9, 22.0)] == [
        True, False, True, False, True, False, True,
    ]  # fmt: skip


def test_what_is_throttled_may_have_a_first_instant() -> None:
    throttle = Throttle(2.0, first=10.0)
    assert [throttle.due(now) for now in (9.9, 10.0, 11.0, 12.0)] == [False, True, False, True]

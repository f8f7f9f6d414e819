"""Line numbers of settings in a TOML text."""

from __future__ import annotations

import pytest

from datagen.settings.toml_lines import line_of

TEXT = '''name = "x"
summary = """
seed = 3
"""
seed = 4

[[part]]
records = 1
[part.defect]  # of the first
depth_um = 1
[[part.wave]]
order = 2
[[part.wave]]
order = 3

[[part]]
machine.rig = "fan"
operation = {speed_rpm = 1}
[[part.wave]]
order = 4
'''


@pytest.mark.parametrize(
    ("location", "line"),
    [
        (("seed",), 5),
        (("part",), 7),
        (("part", 0, "records"), 8),
        (("part", 0, "defect", "depth_um"), 10),
        (("part", 0, "wave", 0, "order"), 12),
        (("part", 0, "wave", 1, "order"), 14),
        (("part", 1, "machine", "rig"), 17),
        (("part", 1, "operation", "speed_rpm"), 18),
        (("part", 1, "wave", 0, "order"), 20),
        (("part", 1, "missing"), 16),
        (("nothing",), None),
    ],
)
def test_a_setting_or_its_innermost_table_is_found_on_its_line(
    location: tuple[str | int, ...], line: int | None
) -> None:
    assert line_of(TEXT, location) == line


def test_signs_that_other_texts_end_lines_with_end_none() -> None:
    assert line_of("# a\u2028b\u0085c\nseed = 4\n", ("seed",)) == 2


def test_what_looks_like_a_setting_in_a_long_text_of_either_kind_is_none() -> None:
    assert line_of("summary = '''\nseed = 3\n'''\nseed = 4\n", ("seed",)) == 4

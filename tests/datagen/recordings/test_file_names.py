"""What a pattern of a SPEC means, held against every way of keeping and leaving out its folders."""

from __future__ import annotations

from fnmatch import fnmatch
from itertools import product
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st

from datagen.recordings.file_names import fits

PATTERNS = st.lists(st.sampled_from(["**/", "*", "?", "a", "b", "/", "[ab]", "[!a]"]), max_size=8).map("".join)
NAMES = st.text("ab/[]*", max_size=10)


def ways(pattern: str) -> set[str]:
    """The pattern with each **/ kept or left out, one by one."""
    first, *others = pattern.split("**/")
    return {
        first + "".join(folders + part for folders, part in zip(kept, others, strict=True))
        for kept in product(("**/", ""), repeat=len(others))
    }


@settings(deadline=None, derandomize=True)
@given(name=NAMES, pattern=PATTERNS)
def test_two_stars_and_a_slash_stand_for_any_folders_or_none(name: str, pattern: str) -> None:
    bare = Path(name).name
    meant = name if "/" in pattern else bare
    expected = pattern in (name, bare) or any(fnmatch(meant, way) for way in ways(pattern))
    assert fits(Path(name), name, pattern) == expected


def test_a_pattern_may_have_any_number_of_them() -> None:
    for pattern in ("**/" * 40 + "x.mat", "".join(f"**/[a-z]{k % 3}*" for k in range(40)) + "**/x.mat"):
        assert not fits(Path("a0/b1/c2/y.mat"), "a0/b1/c2/y.mat", pattern)
    assert fits(Path("a/b/x.mat"), "a/b/x.mat", "**/" * 40 + "x.mat")

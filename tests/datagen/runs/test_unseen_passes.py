"""Planning says of how many records no one can see the ball passes, here by the kinematics of the gearbox rig."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from datagen.recipes.recipe import parse_recipe
from datagen.runs.plan import plan_shards

# 12 balls of 7.12 mm on a pitch diameter of 38.75 mm at 3000 rpm: BPFO 244.9 Hz, BPFI 355.1 Hz.
OPERATION = {"speed_rpm": 3000}
NARROW = "have an envelope band narrower than the ball pass frequency of their spall"
SHORT = "are shorter than the time between two ball passes of their spall: raise signal.duration_s"


def said_of(race: str, signal: dict[str, Any], faulty: int = 10, healthy: int = 0) -> list[str]:
    """What is said of so many records of the gearbox rig, the faulty ones with a spall on `race`."""
    defect = {"condition": "line", "race": race, "extent_deg": 2, "depth_um": 10}
    part = {"machine": {"rig": "gearbox"}, "operation": OPERATION}
    parts: list[dict[str, Any]] = [{**part, "name": "faulty", "records": faulty, "defect": defect}]
    if healthy:
        parts.append({**part, "name": "healthy", "records": healthy})
    signal = {"rate_hz": 65536, "duration_s": 0.1, **signal}
    recipe = parse_recipe({"name": "a", "seed": 1, "signal": signal, "part": parts}, Path("recipe.toml"))
    said: list[str] = []
    plan_shards(recipe, recipe.count, said.append)
    return said


@pytest.mark.parametrize(("race", "width", "told"), [("outer", 250, 0), ("outer", 240, 1), ("inner", 350, 1)])
def test_an_envelope_band_narrower_than_the_ball_pass_frequency_is_told(race: str, width: int, told: int) -> None:
    said = said_of(race, {"envelope_band_hz": (8000, 8000 + width)})
    assert len(said) == told
    assert all(sentence.startswith(f"10 of 10 records {NARROW}") for sentence in said)
    assert not said_of(race, {"envelope_band_hz": (8000, 9000)})


@pytest.mark.parametrize(("race", "milliseconds", "told"), [("outer", 4.2, 0), ("outer", 3.9, 1), ("inner", 3.0, 0)])
def test_records_shorter_than_the_time_between_two_passes_are_told(race: str, milliseconds: float, told: int) -> None:
    assert said_of(race, {"duration_s": milliseconds * 1e-3}) == [f"10 of 10 records {SHORT}"] * told


@pytest.mark.parametrize(("healthy", "told"), [(9, 1), (11, 0)])
def test_what_less_than_a_tenth_of_the_records_lacks_is_not_told(healthy: int, told: int) -> None:
    said = said_of("outer", {"envelope_band_hz": (8000, 8200)}, faulty=1, healthy=healthy)
    assert [sentence.split(" records ")[0] for sentence in said] == [f"1 of {1 + healthy}"] * told


def test_records_without_a_spall_have_no_passes_to_be_seen() -> None:
    signal = {"envelope_band_hz": (8000, 8200), "duration_s": 0.02}
    part = {"name": "healthy", "records": 10, "machine": {"rig": "gearbox"}, "operation": OPERATION}
    recipe = parse_recipe(
        {"name": "a", "seed": 1, "signal": {"rate_hz": 65536, **signal}, "part": [part]}, Path("recipe.toml")
    )
    said: list[str] = []
    plan_shards(recipe, 10, said.append)
    assert not said

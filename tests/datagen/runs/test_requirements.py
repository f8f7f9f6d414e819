"""What can never be made is refused before any worker starts, with what could be."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from command_line import run

from datagen.corpus_files.manifest import manifest_path
from datagen.drawing.portrait_sources import recipe_portrait
from datagen.errors import BadInput
from datagen.recipes.recipe import Recipe, load_recipe, parse_recipe
from datagen.recipes.signal_settings import Signal
from datagen.runs.plan import plan_shards, stored_bytes
from datagen.runs.rates import TooLowRates, lowest_rate
from datagen.runs.requirements import (
    memory_bytes,
    record_memory,
    require_possible_rates,
    require_room,
)
from datagen.scenarios.sampling import draw_scenario
from datagen.settings.docstrings import setting_docstrings

TEXT = """name = "a"
seed = 1
[signal]
rate_hz = 32768
duration_s = 0.05
envelope_band_hz = [10, 40]
[[part]]
name = "gears"
records = 3
machine.rig = "gearbox"
"""
Refused = Callable[[str], str]


@pytest.fixture
def refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Refused:
    """Function (text of a recipe) → the message with which `generate` refuses it before anything is made."""

    def worked(*_: object) -> None:
        raise AssertionError("this was to be refused before any work")

    monkeypatch.setattr("datagen.runs.run.Run.make", worked)

    def refused(text: str) -> str:
        (tmp_path / "recipe.toml").write_text(text)
        command = ["generate", str(tmp_path / "recipe.toml"), "--out", str(tmp_path / "out")]
        done = run(*command)
        assert done.exit_code == 2
        assert done.stderr.count("\n") == 1
        if "disk space" not in done.stderr:  # of which `check` knows nothing, as nobody says where to
            assert run("check", tmp_path) == done
        assert [path.name for path in tmp_path.iterdir()] == ["recipe.toml"]
        return done.stderr

    return refused


def test_a_rate_that_no_record_can_have_is_refused_with_the_lowest_that_it_can(
    refused: Refused, tmp_path: Path
) -> None:
    message = refused(TEXT.replace("32768", "200").replace("0.05", "1"))
    assert 'recipe.toml, line 4: signal.rate_hz = 200.0: part "gears": a rate of 200 Hz has to be raised' in message
    lowest = float(re.findall(r"allowed: about ([\d.]+) Hz or more", message)[0])
    # The highest natural frequency of the gearbox rig, 10548 Hz, four times a period, at 64 times the rate.
    assert lowest == pytest.approx(4.0 * 10548.0 / 64.0, rel=0.005)
    (tmp_path / "recipe.toml").write_text(TEXT.replace("32768", str(lowest)).replace("0.05", "1"))
    require_possible_rates(load_recipe(tmp_path / "recipe.toml"), ((0, 3),))


def test_the_lowest_rates_that_the_key_states_are_those_of_the_rigs() -> None:
    told = " ".join(setting_docstrings(Signal)["rate_hz"].split())
    for rig in ("gearbox", "fan"):
        part = {"name": "a", "records": 1, "machine": {"rig": rig}}
        content = {"name": "a", "seed": 1, "signal": {"rate_hz": 32768, "duration_s": 0.1}, "part": [part]}
        lowest = lowest_rate(draw_scenario(parse_recipe(content, Path("recipe.toml")), 0))
        assert f"{math.ceil(lowest)} Hz for the {rig} rig" in told


def test_the_lowest_rate_is_that_of_the_rig_and_not_of_its_rate(tmp_path: Path) -> None:
    (tmp_path / "recipe.toml").write_text(TEXT)
    scenario = draw_scenario(load_recipe(tmp_path / "recipe.toml"), 0)
    assert lowest_rate(scenario) == pytest.approx(4.0 * 10548.0 / 64.0, rel=0.005)  # contact damping stiffens a little


def test_parts_of_which_some_records_are_possible_are_made(tmp_path: Path) -> None:
    mixed = TEXT.replace('rig = "gearbox"', 'rig = "gearbox"\nmachine.factors.resonator_mass = {choice = [1, 400]}')
    (tmp_path / "recipe.toml").write_text(mixed.replace("32768", "500").replace("0.05", "1").replace("= 3", "= 20"))
    recipe = load_recipe(tmp_path / "recipe.toml")
    possible = [lowest_rate(draw_scenario(recipe, record)) <= 500.0 for record in range(20)]
    assert set(possible) == {True, False}
    one = possible.index(False)
    with pytest.raises(BadInput, match="a rate of 500 Hz has to be raised"):
        require_possible_rates(recipe, ((one, one + 1),))
    assert record_memory(draw_scenario(recipe, one), ()) > 0.0
    require_possible_rates(recipe, ((0, 20),))
    said: list[str] = []
    plan_shards(recipe, 20, said.append)
    needed = max(lowest_rate(draw_scenario(recipe, record)) for record in range(20))
    (sentence,) = said
    assert sentence.startswith(f"{possible.count(False)} of 20 records cannot be made at their sampling rate (for exam")
    assert sentence.endswith(f"signal.rate_hz of about {math.ceil(needed)} or more would do for all")


@pytest.mark.parametrize("rigs", [("gearbox", "fan"), ("fan", "gearbox")])
def test_the_rate_that_would_do_for_all_is_that_of_the_fastest_rig_wherever_it_comes(rigs: tuple[str, ...]) -> None:
    parts = [{"name": rig, "records": 1, "machine": {"rig": rig}} for rig in rigs]
    signal = {"rate_hz": 200, "duration_s": 1, "envelope_band_hz": (10, 40)}
    recipe = parse_recipe({"name": "a", "seed": 1, "signal": signal, "part": parts}, Path("recipe.toml"))
    with pytest.raises(BadInput, match=f'part "{rigs[1]}": a rate of 200 Hz has to be raised'):
        require_possible_rates(recipe, ((1, 2),))  # of the first part nothing is asked
    rates = TooLowRates()
    for record in range(2):
        rates.add(draw_scenario(recipe, record))
    # That of the gearbox rig, as the key rate_hz states it; the fan rig needs 619 Hz.
    assert rates.sentence().endswith("signal.rate_hz of about 660 or more would do for all")


@pytest.mark.parametrize("duration", ["3600", "{uniform = [3000, 3600]}"])
def test_a_record_that_no_memory_holds_is_refused_before_it_is_drawn(
    duration: str, refused: Refused, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("datagen.runs.requirements.memory_bytes", lambda: 16e9)
    monkeypatch.setattr("datagen.runs.requirements.draw_scenario", None)
    message = refused(TEXT.replace("0.05", duration))
    assert "recipe.toml, line 5: signal.duration_s = 3" in message
    assert "GB of memory, and this machine has 16.0 GB" in message
    assert "allowed: at most about 2.2e+03 s at 32768 Hz" in message  # 16e9 bytes of 220 a sample


def test_what_settles_before_a_record_takes_memory_too(refused: Refused, monkeypatch: pytest.MonkeyPatch) -> None:
    # 220 bytes for each of 32 768 samples a second: 0.4 MB for the record alone, 0.7 MB with as much before it.
    monkeypatch.setattr("datagen.runs.requirements.memory_bytes", lambda: 5e5)
    monkeypatch.setattr("datagen.runs.requirements.draw_scenario", None)
    assert "needs about 0.7 MB of memory" in refused(
        TEXT.replace("duration_s = 0.05", "duration_s = 0.05\nsettle_s = 0.05")
    )


@pytest.mark.parametrize(
    ("duration", "settling", "told"),
    [
        (0.05, 0.02, "signal.duration_s = 0.05: {}; allowed: at most about 0.029 s at 32768 Hz"),
        (0.02, 0.05, "signal.settle_s = 0.05: {}; allowed: at most about 0.029 s at 32768 Hz"),
        (0.2, 0.05, "signal.duration_s = 0.2: {}; allowed: at most about 0.049 s, settle_s included, at 32768 Hz"),
    ],
)
def test_what_is_advised_where_memory_is_short_would_fit(
    duration: float, settling: float, told: str, refused: Refused, monkeypatch: pytest.MonkeyPatch
) -> None:
    room = 220.0 * 32768.0 * 0.049  # of 0.049 s at 220 bytes a sample
    monkeypatch.setattr("datagen.runs.requirements.memory_bytes", lambda: room)
    monkeypatch.setattr("datagen.runs.requirements.draw_scenario", None)
    message = refused(
        TEXT.replace("duration_s = 0.05", f"duration_s = {duration}\nsettle_s = {settling}").replace(
            "[10, 40]", "[100, 400]"
        )
    )
    begin, end = told.split("{}")
    assert begin in message
    assert message.rstrip().endswith(end)


def test_a_drawn_record_that_no_memory_holds_is_refused_though_the_shortest_fits(
    refused: Refused, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("datagen.runs.requirements.memory_bytes", lambda: 5e6)
    message = refused(TEXT.replace("0.05", "{choice = [0.05, 100.0], weights = [0.001, 0.999]}"))
    assert "a record of 3.28e+06 samples needs about" in message


def test_a_shard_that_no_memory_holds_is_refused_with_a_smaller_one(
    refused: Refused, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("datagen.runs.requirements.memory_bytes", lambda: 4e6)
    message = refused(TEXT.replace("records = 3", "records = 300") + "[store]\nrecords_per_shard = 300\n")
    most = int(
        re.findall(r"store.records_per_shard = 300: a shard of 300 records .* allowed: at most (\d+)", message)[0]
    )
    assert 1 < most < 300


def test_a_record_that_the_disk_does_not_hold_is_refused(refused: Refused, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("datagen.runs.requirements.shutil.disk_usage", lambda _: type("Disk", (), {"free": 1e6})())
    message = refused(TEXT.replace("0.05", "10"))
    needed, free = re.findall(r"one record needs about ([\d.]+) MB of disk space; ([\d.]+) MB are free", message)[0]
    assert float(needed) > float(free) == 1.0


def test_a_corpus_that_is_there_needs_no_disk_for_another_record(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "recipe.toml").write_text(TEXT)
    recipe = load_recipe(tmp_path / "recipe.toml")
    monkeypatch.setattr("datagen.runs.requirements.shutil.disk_usage", lambda _: type("Disk", (), {"free": 1000})())
    with pytest.raises(BadInput, match="disk space"):
        require_room(recipe, plan_shards(recipe, 3), tmp_path)
    manifest_path(tmp_path).touch()
    require_room(recipe, plan_shards(recipe, 3), tmp_path)


def test_a_preview_is_held_to_the_same_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "recipe.toml").write_text(TEXT)
    monkeypatch.setattr("datagen.runs.requirements.memory_bytes", lambda: 1e5)
    with pytest.raises(BadInput, match=r"signal\.duration_s = 0\.05: a record of 1\.64e\+03 samples needs"):
        recipe_portrait(tmp_path / "recipe.toml", 0)


def test_memory_grows_with_the_rate_that_is_simulated_and_with_what_is_stored(tmp_path: Path) -> None:
    (tmp_path / "recipe.toml").write_text(TEXT)
    recipe = load_recipe(tmp_path / "recipe.toml")
    scenario = draw_scenario(recipe, 0)
    plain, forces = record_memory(scenario, ()), record_memory(scenario, ("contact_force",))
    raw = scenario.samples * 24 * 4  # a float32 for each of 24 balls
    assert forces - plain == pytest.approx(4.0 * raw)
    assert plan_shards(recipe, 1)[0].raw_bytes < plain < memory_bytes()


def test_a_container_has_the_memory_that_it_is_allowed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("datagen.runs.requirements.CONTAINER_LIMIT", tmp_path / "memory.max")
    whole = memory_bytes()
    (tmp_path / "memory.max").write_text("1000000\n")
    assert memory_bytes() == 1e6
    (tmp_path / "memory.max").write_text(f"{2.0 * whole:.0f}\n")
    assert memory_bytes() == whole
    (tmp_path / "memory.max").write_text("max\n")
    assert memory_bytes() == whole


def test_a_record_takes_memory_for_every_simulated_sample(tmp_path: Path) -> None:
    (tmp_path / "recipe.toml").write_text(TEXT)
    scenario = draw_scenario(load_recipe(tmp_path / "recipe.toml"), 0)
    # 10548 Hz ten times a period: four times the rate; 220 bytes a sample, and four copies of what is stored.
    simulated = 220.0 * 4.0 * scenario.samples
    assert record_memory(scenario, ()) == pytest.approx(simulated + 4.0 * stored_bytes(scenario, (), "none"))
    settled = replace(scenario, settle=scenario.duration)
    assert record_memory(settled, ()) - record_memory(scenario, ()) == pytest.approx(simulated)


def test_the_largest_shard_allowed_fits_beside_the_record_that_is_being_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("datagen.runs.requirements.memory_bytes", lambda: 4e6)

    def require(size: int) -> Recipe:
        text = TEXT.replace("records = 3", "records = 300") + f"[store]\nrecords_per_shard = {size}\n"
        (tmp_path / "recipe.toml").write_text(text)
        recipe = load_recipe(tmp_path / "recipe.toml")
        require_room(recipe, plan_shards(recipe, 300), tmp_path)
        return recipe

    with pytest.raises(BadInput) as caught:
        require(300)
    most = int(re.findall(r"at most (\d+)", str(caught.value))[0])
    needed = float(re.findall(r"a shard of 300 records needs about ([\d.]+) MB", str(caught.value))[0])
    recipe = require(most)
    shard = plan_shards(recipe, 1)[0]
    record = record_memory(draw_scenario(recipe, 0), shard.stored)
    assert needed == pytest.approx(300 * 4.0 * shard.raw_bytes / 1e6, abs=0.05)  # one decimal
    assert most * 4.0 * shard.raw_bytes + record <= 4e6 < (most + 1) * 4.0 * shard.raw_bytes + record

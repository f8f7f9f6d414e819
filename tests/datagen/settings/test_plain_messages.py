"""What a recipe's messages say of settings that look right: in the words of the recipe, not of the program."""

from __future__ import annotations

from pathlib import Path

import pytest

from datagen.errors import BadInput
from datagen.recipes.recipe import load_recipe

GOOD = """name = "a"
seed = 1
[signal]
rate_hz = 65536
duration_s = 0.05
[[part]]
name = "p"
records = 2
machine.rig = "gearbox"
"""
RIG = 'machine.rig = "gearbox"\n'


def refusal(text: str, tmp_path: Path) -> str:
    (tmp_path / "r.toml").write_text(text, encoding="utf-8")
    with pytest.raises(BadInput) as problem:
        load_recipe(tmp_path / "r.toml")
    return str(problem.value).removeprefix(str(tmp_path / "r.toml"))


@pytest.mark.parametrize(
    ("shares", "message"),
    [
        ("train = 0.9", "train = 0.9: train = 0.9, validation = 0.15 (its default), test = 0.15 (its default) add up"),
        ("test = 0.5", "test = 0.5: train = 0.7 (its default), validation = 0.15 (its default), test = 0.5 add up to"),
        ("train = 0.5\nvalidation = 0.3\ntest = 0.3", "train = 0.5: train = 0.5, validation = 0.3, test = 0.3 add up"),
    ],
)
def test_shares_that_are_not_one_are_listed_with_those_that_nobody_stated(
    shares: str, message: str, tmp_path: Path
) -> None:
    said = refusal(f"{GOOD}[split]\n{shares}\n", tmp_path)
    assert said.startswith(f", line 11: split.{message}")
    assert said.endswith("allowed: three shares that add up to 1")


def test_more_channels_than_two_are_told_that_fewer_will_do(tmp_path: Path) -> None:
    learnt = f'file = "a.npz"\nrate_hz = 65536\nsamples = 99999\nsha256 = "{"0" * 64}"\n'
    said = refusal(GOOD + f'[background.recording]\n{learnt}channels = ["a", "b", "c"]\n', tmp_path)
    assert said.endswith('background.recording.channels = ["a", "b", "c"]; allowed: at most 2')


def test_a_table_where_a_word_belongs_says_where_its_keys_belong(tmp_path: Path) -> None:
    said = refusal(GOOD + "machine.bearing = {balls = -9}\n", tmp_path)
    assert "part[1].machine.bearing = {balls = -9}: balls: this is a separate setting; write it beside this one" in said
    assert "as part[1].machine.balls; allowed: koyo_1205" in said
    said = refusal(GOOD + "machine.bearing = {balls = 9, colour = 3}\n", tmp_path)
    assert "the keys balls, colour are no distribution" in said
    said = refusal(GOOD.replace('"gearbox"', "{colour = 3}"), tmp_path)
    assert "the keys colour are no distribution: give one of uniform, " in said
    assert "allowed: gearbox, fan" in said
    assert "an empty table is no distribution" in refusal(GOOD.replace('"gearbox"', "{}"), tmp_path)


def test_a_compression_that_is_not_offered_is_refused_with_its_line(tmp_path: Path) -> None:
    said = refusal(f'{GOOD}[store]\ncompression = "lz4"\n', tmp_path)
    assert said.startswith(', line 11: store.compression = "lz4": netCDF\'s own lz4 filter fails')
    assert said.endswith("allowed: zlib, none")
    said = refusal(f'{GOOD}[store]\ncompression = "gzip"\n', tmp_path)
    assert "store.compression = \"gzip\"; allowed: 'zlib' or 'none'" in said


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ('Title = "b"', 'line 1: Title: unknown key; did you mean "title"?'),
        ("str = 3", "line 1: str: unknown key; "),
        ("Signal = {rate_hz = 5}", 'line 1: Signal: unknown key; did you mean "signal"?'),
    ],
)
def test_a_key_is_unknown_under_the_name_it_was_given_whatever_that_looks_like(
    line: str, message: str, tmp_path: Path
) -> None:
    assert message in refusal(f"{line}\n{GOOD}", tmp_path)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        (
            'licence = "CC0"',
            ".licence: unknown key here; it belongs to the top level, above the first table of the file",
        ),
        ("store.clean = true", ".store: unknown key here; it belongs to the top level, as [store]"),
    ],
)
def test_a_key_of_the_top_level_that_came_into_a_table_is_told_its_place(
    line: str, message: str, tmp_path: Path
) -> None:
    assert message in refusal(f"{GOOD}{line}\n", tmp_path)


@pytest.mark.parametrize("when", ["1979-05-27", "07:32:00", "1979-05-27T07:32:00"])
def test_a_date_is_shown_as_it_was_written(when: str, tmp_path: Path) -> None:
    said = refusal(GOOD.replace("seed = 1", f"seed = {when}"), tmp_path)
    assert f"seed = {when}; allowed: a whole number" in said


def test_mains_that_no_record_can_hold_are_refused(tmp_path: Path) -> None:
    hum = "[background.mains_hum]\nfrequency_hz = 40000\namplitude_m_s2 = 1\n[[part]]"
    said = refusal(GOOD.replace("[[part]]", hum), tmp_path)
    assert "background.mains_hum.frequency_hz = 40000" in said
    assert "allowed: below 32768" in said


def test_a_spec_of_recordings_is_no_recipe(tmp_path: Path) -> None:
    said = refusal('name = "a"\n[[recording]]\nname = "b"\n', tmp_path)
    assert "recording: this is a SPEC of recordings, which `spallgen import` brings in, and no recipe" in said


def test_a_byte_order_mark_is_no_matter(tmp_path: Path) -> None:
    (tmp_path / "r.toml").write_text(f"\ufeff{GOOD}", encoding="utf-8")
    assert load_recipe(tmp_path / "r.toml").name == "a"


def test_a_recipe_that_may_not_be_read_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "r.toml").write_text(GOOD)

    def forbidden(*_: object, **__: object) -> str:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "read_text", forbidden)
    with pytest.raises(BadInput, match=r"r\.toml: cannot be read: Permission denied"):
        load_recipe(tmp_path / "r.toml")


@pytest.mark.parametrize("name", ["Fs", "sampling_rate", "SR"])
def test_a_setting_is_known_by_what_others_call_it_in_capitals_too(name: str, tmp_path: Path) -> None:
    said = refusal(GOOD.replace("rate_hz", name), tmp_path)
    assert f'signal.{name}: unknown key; did you mean "rate_hz"?' in said


@pytest.mark.parametrize(
    ("header", "stray"),
    [
        ("[[part]]", "[signal.part]"),
        ("[split]", "[signal.split]"),
    ],
)
def test_a_table_within_another_is_told_its_own_header(header: str, stray: str, tmp_path: Path) -> None:
    said = refusal(GOOD.replace("[[part]]", f"{stray}\n[[part]]"), tmp_path)
    assert said.endswith(f"unknown key here; it belongs to the top level, as {header}")


def test_a_key_of_a_part_is_told_the_double_brackets_of_parts(tmp_path: Path) -> None:
    said = refusal(GOOD.replace("[[part]]", "records = 2\n[[part]]"), tmp_path)
    assert said.endswith("signal.records: unknown key here; it belongs in [[part]]")

"""Recipes: what is read, what identifies it, and what is refused in one line with file, setting and what is allowed."""

from __future__ import annotations

import hashlib
import json
import pickle
from pathlib import Path

import pytest

from datagen.errors import BadInput
from datagen.recipes.recipe import Recipe, load_recipe, parse_recipe

GOOD = """name = "try"
seed = 1

[signal]
rate_hz = 65536
duration_s = 0.5

[[part]]
name = "a"
records = 5
records_per_machine = 2
machine.rig = "gearbox"

[part.operation]
speed_of_rated = {uniform = [0.5, 1.5]}

[part.defect]
condition = "line"
extent_deg = 2
depth_um = 12

[[part]]
name = "b"
records = 3
machine = {rig = {choice = ["gearbox", "fan"]}}
"""


def write(folder: Path, *swaps: tuple[str, str]) -> Path:
    """The good recipe with some of its text replaced, as a file."""
    text = GOOD
    for old, new in swaps:
        assert text.count(old) >= 1
        text = text.replace(old, new, 1)
    path = folder / "recipe.toml"
    path.write_text(text, encoding="utf-8")
    return path


def refusal(folder: Path, *swaps: tuple[str, str]) -> BadInput:
    """The error of the good recipe with some of its text replaced."""
    with pytest.raises(BadInput) as caught:
        load_recipe(write(folder, *swaps))
    assert "\n" not in str(caught.value)
    assert str(folder / "recipe.toml") in str(caught.value)
    return caught.value


def test_records_are_counted_over_parts_and_machines_over_their_records(tmp_path: Path) -> None:
    recipe = load_recipe(write(tmp_path))
    assert recipe.count == 8
    assert [recipe.place(record) for record in range(8)] == [
        (0, 0, 0, 0, 0), (0, 0, 1, 0, 1), (0, 1, 2, 1, 0), (0, 1, 3, 1, 1), (0, 2, 4, 2, 0),
        (1, 3, 0, 0, 0), (1, 4, 1, 1, 0), (1, 5, 2, 2, 0),
    ]  # fmt: skip
    with pytest.raises(BadInput, match=r"record = 8; allowed: 0 to 7"):
        recipe.place(8)


def test_the_hash_is_of_what_a_recipe_says_not_of_how_it_is_written(tmp_path: Path) -> None:
    plain = load_recipe(write(tmp_path)).hash
    rewritten = load_recipe(
        write(tmp_path, ("seed = 1\n", "# a comment\nseed   = 1 # another\n"), ("rate_hz = 65536", "rate_hz = 65536.0"))
    )
    assert rewritten.hash == plain
    assert load_recipe(write(tmp_path, ("seed = 1", "seed = 2"))).hash != plain
    assert load_recipe(write(tmp_path, ("depth_um = 12", "depth_um = 13"))).hash != plain


def test_a_band_narrower_than_lines_lie_apart_is_taken_only_where_all_records_have_the_same_lines(
    tmp_path: Path,
) -> None:
    band = ("duration_s = 0.5", "duration_s = 0.5\nenvelope_band_hz = [19999.5, 20000.5]")  # lines are at even numbers
    assert load_recipe(write(tmp_path, band)).signal.envelope_band_hz == (19999.5, 20000.5)
    drawn = ("rate_hz = 65536", "rate_hz = {choice = [65536.0, 65540.0]}")
    assert "which lie 2 Hz apart; allowed: a band at least 2 wide" in str(refusal(tmp_path, drawn, band))


def test_the_hash_is_of_the_whole_recipe_as_data_with_its_defaults(tmp_path: Path) -> None:
    recipe = load_recipe(write(tmp_path))
    content = recipe.model_dump(mode="json")
    assert content["signal"]["settle_s"] == 0.0  # nobody stated it
    text = json.dumps(content, sort_keys=True, separators=(",", ":"))
    assert recipe.hash == hashlib.sha256(text.encode()).hexdigest()


def test_the_hash_covers_the_numbers_of_a_measured_table(tmp_path: Path) -> None:
    table = tmp_path / "pit.csv"
    swap = ("extent_deg = 2\ndepth_um = 12", 'profile = "table"\ntable = "pit.csv"')
    table.write_text("angle_deg,depth_um\n0,0\n1,10\n2,0\n")
    first = load_recipe(write(tmp_path, swap)).hash
    table.write_text("angle_deg,depth_um\n0,0\n1,11\n2,0\n")
    assert load_recipe(write(tmp_path, swap)).hash != first


def test_a_recipe_kept_as_data_reads_back_as_itself(tmp_path: Path) -> None:
    (tmp_path / "pit.csv").write_text("angle_deg,depth_um\n0,0\n1,10\n2,0\n")
    recipe = load_recipe(write(tmp_path, ("depth_um = 12", 'depth_um = 12\ntable = "pit.csv"')))
    data = json.loads(json.dumps(recipe.model_dump(mode="json")))
    assert parse_recipe(data, Path("manifest.json")).hash == recipe.hash


def test_a_recipe_sent_to_another_process_keeps_its_hash_and_its_source(tmp_path: Path) -> None:
    recipe = load_recipe(write(tmp_path))
    again: Recipe = pickle.loads(pickle.dumps(recipe))
    assert (again.hash, again.source) == (recipe.hash, str(tmp_path / "recipe.toml"))


def test_an_error_sent_from_another_process_keeps_its_text(tmp_path: Path) -> None:
    error = refusal(tmp_path, ("depth_um = 12", "depth_um = -12"))
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.field, again.allowed) == (str(error), error.field, error.allowed)


def test_a_negative_depth_is_refused_with_file_line_field_value_and_range(tmp_path: Path) -> None:
    error = refusal(tmp_path, ("depth_um = 12", "depth_um = -12"))
    assert (error.field, error.value, error.allowed) == ("part[1].defect.depth_um", -12, "a number from 0 to 10000")
    assert str(error) == (
        f"{tmp_path / 'recipe.toml'}, line 20: part[1].defect.depth_um = -12; allowed: a number from 0 to 10000"
    )


@pytest.mark.parametrize(
    ("old", "new", "field", "words"),
    [
        ("depth_um = 12", "depth_um = {uniform = [-1, 5]}", "part[1].defect.depth_um", "from 0 to 10000"),
        ("depth_um = 12", "depth_um = {uniform = [5, 1]}", "part[1].defect.depth_um", "the smaller number comes first"),
        ("depth_um = 12", "depht_um = 12", "part[1].defect.depht_um", 'did you mean "depth_um"?'),
        ("depth_um = 12", 'depth_um = "deep"', "part[1].defect.depth_um", "a number from 0 to 10000"),
        ("depth_um = 12", "depth_um = true", "part[1].defect.depth_um", "a number from 0 to 10000"),
        ("depth_um = 12", "", "part[1].defect.depth_um", "has no depth; allowed: a number from 0 to 10000"),
        ("depth_um = 12", "depth_um = 0", "part[1].defect.depth_um", "neither depth nor roughness"),
        ("depth_um = 12", "depth_um = 0\nroughness_um = 0", "part[1].defect.depth_um", "or a roughness_um above 0"),
        ("extent_deg = 2", "extent_deg = 0", "part[1].defect.extent_deg", "a number above 0 to 180"),
        ("extent_deg = 2", "", "part[1].defect.extent_deg", "one of extent_deg, extent_mm, extent_spacing"),
        ("depth_um = 12", "depth_um = 12\nextent_mm = 1", "part[1].defect.extent_mm", "set the same thing twice"),
        (
            "depth_um = 12",
            "depth_um = 12\nentry_taper_deg = 2.5",
            "part[1].defect.entry_taper_deg",
            "2.5 is longer than the spall",
        ),
        (
            "depth_um = 12",
            "depth_um = 12\nentry_taper_share = 0.7\nexit_taper_deg = 1",
            "part[1].defect.exit_taper_deg",
            "longer than the spall",
        ),
        ("depth_um = 12", "depth_um = 12\nrow = 3", "part[1].defect.row", "1, 2, both, any"),
        ("depth_um = 12", 'depth_um = 12\ndrawn_for = "rig"', "part[1].defect.drawn_for", "'record' or 'machine'"),
        (
            "depth_um = 12",
            "depth_um = 12\nhealthy_records = 3",
            "part[1].defect.healthy_records",
            "at most 2, the records of each machine",
        ),
        ("records = 5", 'records = 5\ndesign = "sobel"', "part[1].design", "'sobol'"),
        ("records = 5", 'records = 50001\ndesign = "latin_hypercube"', "part[1].design", "at most 50000 records"),
        ('"gearbox"', '"drawn"', "part[1].machine.bearing", "a drawn rig needs this setting"),
        (
            '"gearbox"',
            '"gearbox"\nmachine.bearing = "drawn"\nmachine.fill = 0.9\nmachine.balls = 8',
            "part[1].machine.fill",
            "balls and fill set the same thing twice",
        ),
        (
            '"gearbox"',
            '"gearbox"\nmachine.bearing = "drawn"\nmachine.fill = 0.9\nmachine.rows = 1\n'
            "machine.pitch_diameter_mm = 40",
            "part[1].machine.ball_diameter_of_pitch",
            "one of ball_diameter_mm, ball_diameter_of_pitch",
        ),
        (
            '"gearbox"',
            '"gearbox"\nmachine.factors.inner_mas = 2',
            "part[1].machine.factors.inner_mas",
            'did you mean "inner_mass"?',
        ),
        ("depth_um = 12", "depth_um = 12\ncount = {uniform = [1, 3]}", "part[1].defect.count", "by choice"),
        ('condition = "line"', 'condition = "lime"', "part[1].defect.condition", 'did you mean "line"?'),
        ('condition = "line"', 'condition = "line"\nprofile = "table"', "part[1].defect.table", "needs a file"),
        ('"gearbox"', '"gear_box"', "part[1].machine.rig", 'did you mean "gearbox"?'),
        ('choice = ["gearbox", "fan"]', 'choice = ["fun"]', "part[2].machine.rig", 'did you mean "fan"?'),
        ("65536", "65536\nenvelope_band_hz = [9000, 40000]", "signal.envelope_band_hz", "high <= 32768"),
        ("65536", "65536\nenvelope_band_hz = [9000, 8000]", "signal.envelope_band_hz", "the band is empty"),
        ("65536", "65536\nenvelope_band_hz = [-5, 8000]", "signal.envelope_band_hz", "the band begins below 0 Hz"),
        ("0.5\n", "0.0011\n[store]\nclean = 1\n", "store.clean", "true or false"),
        ("seed = 1", "seed = -1", "seed", "at least 0"),
        ("seed = 1", "seed = 1.5", "seed", "a whole number"),
        ("seed = 1", 'seed = "1"', "seed", "a whole number"),
        ("seed = 1", "sed = 1", "sed", 'did you mean "seed"?'),
        ("seed = 1\n", "", "seed", "missing"),
        ("records = 5", "records = 0", "part[1].records", "at least 1"),
        ('name = "try"', 'name = "a b"', "name", "letters, digits"),
        ('name = "b"', 'name = "a"', "part", 'two parts are called "a"'),
        ("[signal]", '[store]\ncompression = "zip"\n[signal]', "store.compression", "zlib"),
        ("[signal]", "[split]\ntrain = 0.9\n[signal]", "split.train", "add up to 1.2"),
        ("[signal]", "[split]\ntrain = 0.5\n[signal]", "split.train", "add up to 0.8"),
        ("speed_of_rated", "speed_rpm = 100\nspeed_of_rated", "part[1].operation.speed_of_rated", "twice"),
        (
            "[part.operation]",
            "[part.operation]\nunbalance_n = 1\nunbalance_grade_mm_per_s = 1",
            "part[1].operation.unbalance_grade_mm_per_s",
            "twice",
        ),
        ("[part.operation]", "[part.operation]\nload_n = -1", "part[1].operation.load_n", "from 0"),
    ],
)
def test_bad_settings_are_refused_by_name(tmp_path: Path, old: str, new: str, field: str, words: str) -> None:
    error = refusal(tmp_path, (old, new))
    assert error.field == field
    assert words in str(error)
    assert ", line " in str(error) or "missing" in str(error)


def test_a_record_of_fewer_than_16_samples_is_refused(tmp_path: Path) -> None:
    error = refusal(tmp_path, ("65536", "1000"), ("duration_s = 0.5", "duration_s = 0.01"))
    assert (error.field, error.allowed) == ("signal.duration_s", "at least 0.016 at 1000 Hz")


def test_a_part_in_single_brackets_is_told_to_use_double_ones(tmp_path: Path) -> None:
    path = tmp_path / "recipe.toml"
    path.write_text('name = "x"\nseed = 1\nsignal = {rate_hz = 1000, duration_s = 1}\n[part]\nname = "a"\n')
    with pytest.raises(BadInput, match=r"line 4: part.*\[\[part\]\]"):
        load_recipe(path)


def test_a_syntax_error_is_refused_with_its_line(tmp_path: Path) -> None:
    assert "at line 2, column 8" in str(refusal(tmp_path, ("seed = 1", "seed = = 1")))


def test_a_file_that_is_no_text_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "recipe.toml"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(BadInput, match="not a UTF-8 text file"):
        load_recipe(path)


def test_a_condition_may_have_its_own_size_in_its_own_table(tmp_path: Path) -> None:
    path = write(
        tmp_path,
        ('condition = "line"', 'condition = {choice = ["healthy", "line", "extended"]}'),
        ("depth_um = 12", "depth_um = 12\n[part.defect.extended]\nextent_spacing = 1.5"),
    )
    defect = load_recipe(path).part[0].defect
    assert defect is not None
    line, extended = defect.refined["line", "outer", "tukey"], defect.refined["extended", "outer", "tukey"]
    assert (line.extent_deg, line.extent_spacing) == (defect.extent_deg, None)
    assert (extended.extent_deg, extended.depth_um) == (None, defect.depth_um)
    assert extended.extent_spacing is not None
    assert extended.extent_spacing.stated() == (1.5,)
    assert set(defect.refined) == {("line", "outer", "tukey"), ("extended", "outer", "tukey")}


def test_a_normal_distribution_is_cut_off_at_what_is_allowed(tmp_path: Path) -> None:
    defect = load_recipe(write(tmp_path, ("depth_um = 12", "depth_um = {normal = [1, 5]}"))).part[0].defect
    assert defect is not None
    assert defect.depth_um is not None
    assert defect.depth_um.quantile(0.0) >= 0.0
    assert defect.depth_um.to_toml() == {"normal": [1.0, 5.0], "low": 0.0, "high": 1e4}


def test_all_records_of_a_machine_may_be_healthy_before_it_is_damaged(tmp_path: Path) -> None:
    recipe = load_recipe(write(tmp_path, ("depth_um = 12", "depth_um = 12\nhealthy_records = 2")))
    assert recipe.part[0].defect is not None
    assert recipe.part[0].defect.healthy_records == recipe.part[0].records_per_machine == 2

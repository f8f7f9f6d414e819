"""Numbers that no machine has, whether stated or read from the file, and what is said twice or of nothing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from imports import Bring, Mat, refusal

from datagen.errors import BadInput
from datagen.recordings.spec import load_spec

GOOD = """[[recording]]
name = "all"
files = "*.mat"
unit = "g"
rate_hz = 1000
y = "sig"
"""
RATE = "rate_hz = 1000"
STATED = {
    "rate_hz = 1": "rate_hz = 1; allowed: a number from 100 to 1e+07",
    "rate_hz = 1e15": "rate_hz = 1000000000000000.0; allowed: a number from 100 to 1e+07",
    "load_n = -5": "load_n = -5; allowed: a number from 0 to 1e+07",
    "speed_rpm = 1e300": "speed_rpm = 1e+300; allowed: a number from 0 to 1e+06",
    "extent_deg = 400": "extent_deg = 400; allowed: a number above 0 to 360",
    "extent_mm = 5e9": "extent_mm = 5000000000.0; allowed: a number above 0 to 10000",
    "depth_um = inf": "depth_um = inf; allowed: a number above 0 to 100000",
    "depth_um = 0": "depth_um = 0; allowed: a number above 0 to 100000",
    "extent_deg = 0": "extent_deg = 0; allowed: a number above 0 to 360",
    "extent_mm = 0": "extent_mm = 0; allowed: a number above 0 to 10000",
    "speed_hz = 16700": "speed_hz = 16700; allowed: a number from 0 to 16666.7",
    "scale = inf": "scale = inf; allowed: a number, or",
    "scale = nan": "scale = nan; allowed: a number, or",
    "snr_db = 1e9": "snr_db = 1000000000.0; allowed: a number from -100 to 200",
    "spalls = 100000000000000000000": "spalls = 100000000000000000000; allowed: at most 10000",
    "bpfo = 1e30": "bpfo = 1e+30; allowed: a number from 0.001 to 1000",
    "ftf = 11.9": "ftf = 11.9; allowed: a number from 0.001 to 1",
    "ftf = 1e-310": "ftf = 1e-310; allowed: a number from 0.001 to 1",
    "from_s = 1e305": "from_s = 1e+305; allowed: at most 1000000000.0",
    "to_s = 1e305": "to_s = 1e+305; allowed: at most 1000000000.0",
    "cut_s = 1e305": "cut_s = 1e+305; allowed: at most 1000000000.0",
    "csv = {skip_lines = 9000000000000}": "csv.skip_lines = 9000000000000; allowed: at most 1000000000",
    "bearing = {balls = 9, ball_diameter_mm = 0.00794, pitch_diameter_mm = 0.03904}": "bearing.pitch_diameter_mm = "
    "0.03904; allowed: at least 0.1",
    "notes = {torque = nan}": "notes.torque = nan: not a finite number; allowed: texts, finite numbers, true or false",
    "cut_s = -1": "cut_s = -1; allowed: above 0",
}
HELD = {
    'rate_hz = {variable = "sig"}': 'rate_hz = "sig": holds 400 numbers from',
    'rate_hz = {variable = "huge"}': "rate_hz = 1e+300: from the variable huge; allowed: a number from 100 to 1e+07",
    'rate_hz = {variable = "huge", factor = 1e300}': "rate_hz = inf: from the variable huge; allowed: a number",
    'rate_hz = {variable = "khz"}': "rate_hz = 12.0: from the variable khz; allowed: a number from 100 to 1e+07; "
    "factor = … brings it to the unit of the setting, as 1000 a rate in kHz",
    'load_n = {variable = "minus"}': "load_n = -3.0: from the variable minus; allowed: a number from 0 to 1e+07",
    'speed_rpm = {variable = "minus"}': "speed_rpm = -3.0: from the variable minus; allowed: a number from 0 to 1e+06",
    "scale = 1e308": "scale = 1e+308: the largest sample would be inf m/s²; allowed: samples up to 1e+09 m/s²",
    "scale = 1e9": "scale = 1000000000.0: the largest sample would be",
    'rate_hz = {variable = "huge", times = true, factor = 1e300}': 'rate_hz = "huge": is not a column of rising times',
    'recording = "{stem:999999999999}"': 'recording = "{stem:999999999999}": a width in braces; allowed: at most 999',
    'tach = {variable = "saw", pulses_per_rev = 0.002}': "tach.pulses_per_rev = 0.002: its pulses give 6e+06",
}


def with_setting(setting: str) -> str:
    return GOOD.replace(RATE, setting) if setting.startswith("rate_hz") else GOOD + setting + "\n"


@pytest.mark.parametrize("setting", STATED)
def test_a_number_beyond_any_machine_is_refused_with_its_range(
    setting: str, bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    message = refusal(bring, with_setting(setting), tmp_path)
    assert f"recording[1].{STATED[setting]}" in message
    assert "spec.toml, line " in message


@pytest.mark.parametrize("setting", HELD)
def test_the_same_holds_for_a_number_that_the_file_holds_or_leads_to(
    setting: str, bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    saw = np.tile([0.0, 0.0, 1.0, 1.0, 0.0], 80)  # 200 pulses a second
    mat("a.mat", huge=1e300, khz=12.0, minus=-3.0, saw=saw)
    message = refusal(bring, with_setting(setting), tmp_path)
    assert f"a.mat: {HELD[setting]}" in message


@pytest.mark.parametrize(
    ("orders", "message"),
    [
        ("bpfo = 107.4\nbpfi = 162.2", "bpfo = 107.4: with bpfi = 162.2 it would mean a bearing with 269.6 balls"),
        ("bpfo = 5.42\nbpfi = 3.58", "bpfo = 5.42: with bpfi = 3.58 it would mean a bearing with 9 balls"),
        ("bpfo = 4.5\nbpfi = 4.5", "bpfo = 4.5: with bpfi = 4.5 it would mean a bearing with 9 balls"),
    ],
    ids=["in Hz", "exchanged", "alike"],
)
def test_orders_that_no_bearing_has_are_refused(
    orders: str, message: str, bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    allowed = "; allowed: orders of the shaft, bpfo below bpfi; their sum is the number of balls, at most 200"
    assert refusal(bring, f"{GOOD}{orders}\n", tmp_path).endswith(f"recording[1] (all): {message}{allowed}")
    for known in ("bpfo = 3.58\nbpfi = 5.42\nftf = 0.398", "bpfo = 3.58", "bpfi = 5.42", "bpfo = 99\nbpfi = 101"):
        assert len(bring(f"{GOOD}{known}\n", known)) == 1


NOT_WHOLE = "; allowed: orders whose sum is the number of balls, within 0.05 of a whole number"
NOT_CAGE = "; allowed: bpfo over the number of balls, within 1%"


@pytest.mark.parametrize(
    ("orders", "message"),
    [
        (
            "bpfo = 3.585\nbpfi = 5.2",
            f"bpfo = 3.585: with bpfi = 5.2 it would mean a bearing with 8.785 balls{NOT_WHOLE}",
        ),
        (
            "bpfo = 3.585\nbpfi = 5.415\nftf = 0.45",
            f"ftf = 0.45: with bpfo = 3.585 and 9 balls it should be 0.3983{NOT_CAGE}",
        ),
        ("bpfo = 3.585\nftf = 0.38", f"ftf = 0.38: with bpfo = 3.585 and 9 balls it should be 0.3983{NOT_CAGE}"),
        (
            "bpfo = 3.64\nbpfi = 5.42",
            f"bpfo = 3.64: with bpfi = 5.42 it would mean a bearing with 9.06 balls{NOT_WHOLE}",
        ),
        ("bpfo = 3.585\nftf = 0.403", f"ftf = 0.403: with bpfo = 3.585 and 9 balls it should be 0.3983{NOT_CAGE}"),
        ("bpfo = 0.4\nftf = 0.9", f"ftf = 0.9: with bpfo = 0.4 and 1 balls it should be 0.4{NOT_CAGE}"),
    ],
    ids=["sum", "cage", "cage without bpfi", "sum by little", "cage by little", "less than a ball"],
)
def test_orders_that_do_not_fit_each_other_are_refused(
    orders: str, message: str, bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    assert refusal(bring, f"{GOOD}{orders}\n", tmp_path).endswith(f"recording[1] (all): {message}")
    near = "bpfo = 3.62\nbpfi = 5.42"  # 9.04 balls
    for rounded in ("bpfo = 3.6\nbpfi = 5.4\nftf = 0.398", near, "bpfo = 3.585\nftf = 0.401"):  # 0.7 % above 0.3983
        assert len(bring(f"{GOOD}{rounded}\n", rounded)) == 1


def test_a_defect_longer_than_its_race_is_refused(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    message = refusal(bring, GOOD + 'bearing = "koyo_1205"\nlocation = "outer"\nextent_mm = 150\n', tmp_path)
    # Pitch and ball diameter of the Koyo 1205, 38.75 mm and 7.12 mm, give a race of pi times 45.87 mm.
    assert "extent_mm = 150.0; allowed: a number above 0 up to 144.1, the circumference of the outer race" in message


def test_an_override_of_no_file_is_refused_unless_files_may_be_absent(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    override = '[[recording.override]]\nfiles = ["a.mat", "z*.mat"]\nload_n = 3\n'
    message = refusal(bring, GOOD + override, tmp_path)
    assert 'override[1]: files = "z*.mat": matches none of these recordings; allowed: a.mat; with absent' in message
    assert bring(GOOD + 'absent_files = "skip"\n' + override).labels["load_n"].tolist() == [3.0]


def test_a_column_that_is_there_twice_is_refused_and_one_without_a_name_is_not(bring: Bring, tmp_path: Path) -> None:
    cells = "".join(f"{k % 7},{k % 5},\n" for k in range(50))
    spec = GOOD.replace("*.mat", "a.csv")
    (tmp_path / "a.csv").write_text("sig,sig,\n" + cells)
    message = refusal(bring, spec, tmp_path)
    assert "a.csv, line 1: sig: this column occurs twice" in message
    assert "header = false" in message
    (tmp_path / "a.csv").write_text("sig,,\n" + cells)
    assert len(bring(spec)) == 1


def test_a_recipe_is_no_spec_and_a_byte_order_mark_is_no_matter(tmp_path: Path) -> None:
    path = tmp_path / "spec.toml"
    path.write_text('name = "a"\n[[part]]\nname = "b"\n')
    with pytest.raises(BadInput, match=r"part: this is a recipe.*spallgen generate.*allowed: \[\[recording\]\]"):
        load_spec(path)
    path.write_text(f'\ufeffname = "mine"\n{GOOD}', encoding="utf-8")
    assert load_spec(path).name == "mine"


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ('rate_hz = {variabel = "fs"}', 'rate_hz.variabel: unknown key; did you mean "variable"?'),
        ('rate_hz = {variable = "fs", factor = inf}', "rate_hz.factor = inf; allowed: a finite number"),
        ('Rate_hz = {variable = "fs"}', 'Rate_hz: unknown key; did you mean "rate_hz"?'),
        ("bearing = {balls = 8, D = 39}", "bearing.D: unknown key (known here: name, balls, "),
        ('tach = {variable = "fs", PPR = 2}', "tach.PPR: unknown key (known here: variable, pulses_per_rev, "),
        ("bearing = {balls = 8}", "bearing.pitch_diameter_mm: this setting is missing"),
        ('bearing = {balls = "x", pitch_diameter_mm = 9, ball_diameter_mm = 2}', 'bearing.balls = "x"; allowed: a'),
        ("bearing = 7", "bearing = 7; allowed: a text in quotes or a table"),
    ],
)
def test_where_a_word_or_a_table_may_stand_the_message_is_about_what_was_written(
    setting: str, message: str, bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    assert f"recording[1].{message}" in refusal(bring, with_setting(setting), tmp_path)


@pytest.mark.parametrize(("name", "order", "balls"), [("bpfo", 500.0, 1000), ("bpfi", 300.0, 300)])
def test_one_order_alone_may_say_that_it_is_no_order(
    name: str, order: float, balls: int, bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    mat("a.mat")
    message = refusal(bring, with_setting(f"{name} = {order}"), tmp_path)
    assert f"{name} = {order}: it would mean a bearing with more than {balls} balls; allowed: an order of" in message

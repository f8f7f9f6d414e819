"""What no recipe may say: one message with file, line, setting, value and what is allowed; exit 2; nothing written."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from command_line import run

GOOD = """name = "bad"
seed = 1
[signal]
rate_hz = 65536
duration_s = 0.05
[[part]]
name = "a"
records = 2
machine.rig = "gearbox"
[part.defect]
condition = "line"
extent_spacing = 0.1
depth_um = 12
"""
RIG = """machine.bearing = "drawn"
machine.rows = 1
machine.pitch_diameter_mm = 40
machine.ball_diameter_of_pitch = 0.2
machine.fill = 0.9
"""
CASES = {
    "a negative depth": ("depth_um = 12", "depth_um = -12", 13, "part[1].defect.depth_um = -12", "from 0 to 10000"),
    "a drawn depth that may be negative": (
        "depth_um = 12",
        "depth_um = {uniform = [-1, 4]}",
        13,
        "part[1].defect.depth_um = {uniform = [-1, 4]}",
        "from 0 to 10000",
    ),
    "a taper longer than its spall, both in degrees": (
        "extent_spacing = 0.1",
        "extent_deg = 2\nexit_taper_deg = 3",
        13,
        "part[1].defect.exit_taper_deg",
        "3 is longer than the spall, extent_deg = 2; allowed: 0 to 2",
    ),
    "a taper longer than its spall, each in its own unit": (
        "depth_um = 12",
        "depth_um = 12\nentry_taper_deg = 4",
        14,
        "part[1].defect.entry_taper_deg = 4.0",
        "the entry taper of 4 degrees is longer than the spall of 3 degrees",
    ),
    "tapers longer than the spall together": (
        "depth_um = 12",
        "depth_um = 12\nentry_taper_share = 0.7\nexit_taper_share = 0.6",
        15,
        "part[1].defect.exit_taper_share",
        "at most the whole spall",
    ),
    "a band above half the rate": (
        "duration_s = 0.05",
        "duration_s = 0.05\nenvelope_band_hz = [9000, 40000]",
        6,
        "signal.envelope_band_hz = [9000, 40000]",
        "0 <= low < high <= 32768",
    ),
    "a band for the noise above half the rate": (
        "[[part]]",
        "[background]\nsnr_band_hz = [9000, 40000]\n[[part]]",
        7,
        "background.snr_band_hz",
        "0 <= low < high <= 32768",
    ),
    "a band between two lines of the spectrum": (
        "duration_s = 0.05",
        "duration_s = 0.05\nenvelope_band_hz = [1001, 1002]",
        6,
        "signal.envelope_band_hz = [1001, 1002]",
        "which lie 19.9988 Hz apart; allowed: a band at least 19.9988 wide",
    ),
    "a band that holds no line of the shortest record": (
        "duration_s = 0.05",
        "duration_s = {uniform = [0.025, 0.05]}\nenvelope_band_hz = [1000, 1030]",
        6,
        "signal.envelope_band_hz = [1000, 1030]",
        "which lie 40.0098 Hz apart; allowed: a band at least 40.0098 wide",
    ),
    "a band for the noise between two lines of the spectrum": (
        "[[part]]",
        "[background]\nsnr_band_hz = [1001, 1002]\n[[part]]",
        7,
        "background.snr_band_hz",
        "which lie 19.9988 Hz apart; allowed: a band at least 19.9988 wide",
    ),
    "a resonance of the catalogue above half the rate": (
        "rate_hz = 65536",
        "rate_hz = 16384",
        9,
        'part[1].machine.rig = "gearbox": its resonance at 10547 Hz',
        "signal.rate_hz above about 22150",
    ),
    "a drawn resonance above half the rate": (
        'rig = "gearbox"',
        'rig = "gearbox"\nmachine.resonator_frequency_hz = {uniform = [9000, 33000]}',
        10,
        "part[1].machine.resonator_frequency_hz = 33000",
        "below 32768",
    ),
    "a resonance of the sensor's mounting above half the rate": (
        "[[part]]",
        "[[chain.modes]]\nfrequency_hz = 33000\ndamping = 0.02\n[[part]]",
        7,
        "chain.modes[1].frequency_hz = 33000",
        "below 32768",
    ),
    "balls that never fit": (
        'rig = "gearbox"',
        'rig = "gearbox"\nmachine.ball_diameter_mm = 20',
        10,
        "part[1]",
        "12 balls of 20.000 mm do not fit on a pitch circle of 38.750 mm",
    ),
    "a drawn bearing of only two balls": (
        'rig = "gearbox"\n',
        f'rig = "gearbox"\n{RIG.replace("fill = 0.9", "balls = 2")}',
        14,
        "part[1].machine.balls = 2",
        "a whole number from 3 to 200",
    ),
    "a drawn bearing without the number of its balls": (
        'rig = "gearbox"\n',
        f'rig = "gearbox"\n{RIG.replace("machine.fill = 0.9", "")}',
        6,
        "part[1].machine.fill",
        "one of balls, fill",
    ),
    "a line spall that is always as long as the ball spacing": (
        "extent_spacing = 0.1",
        "extent_spacing = {uniform = [1, 2]}",
        12,
        "part[1].defect.extent_spacing = {uniform = [1, 2]}",
        "1 is no line spall; allowed: below 1 ball spacing",
    ),
    "a line spall that is by less than a rounding shorter than the ball spacing": (
        "extent_spacing = 0.1",
        "extent_spacing = 0.9999999995",
        12,
        "part[1].defect.extent_spacing = 0.9999999995",
        "is no line spall; allowed: below 1 ball spacing",
    ),
    "a title that steers terminals": (
        'name = "bad"',
        'name = "bad"\ntitle = "x\\u001b[31mred"',
        2,
        "title = ",
        "holds the control character U+001B; allowed: text without control characters",
    ),
    "a summary with the one sign that begins such a code": (
        'name = "bad"',
        'name = "bad"\nsummary = "x\u009b31mred"',
        2,
        "summary = ",
        "holds the control character U+009B; allowed: text without control characters",
    ),
    "a name of a part that steers terminals": (
        'name = "a"',
        'name = "a\\u001b[31m"',
        7,
        "part[1].name = ",
        "holds the control character U+001B; allowed: text without control characters",
    ),
    "half a record": (
        "records = 2",
        "records = 2.5",
        8,
        "part[1].records = 2.5",
        "a whole number from 1 to 10000000",
    ),
    "a share in words": (
        "[[part]]",
        '[split]\ntrain = "most"\n[[part]]',
        7,
        'split.train = "most"',
        "a number from 0 to 1",
    ),
    "a misspelt distribution": (
        "depth_um = 12",
        "depth_um = {unifrm = [1, 2]}",
        13,
        "part[1].defect.depth_um",
        'did you mean "uniform"?',
    ),
    "a misspelt factor": (
        'rig = "gearbox"',
        'rig = "gearbox"\nmachine.factors.support_stifness = 2',
        10,
        "part[1].machine.factors.support_stifness",
        'did you mean "support_stiffness"?',
    ),
    "a misspelt share of the split": (
        "[signal]",
        "[split]\ntrian = 1.0\n[signal]",
        4,
        "split.trian",
        'did you mean "train"? (known here: train, validation, test)',
    ),
    "a misspelt table": ("[part.defect]", "[part.defekt]", 10, "part[1].defekt", 'did you mean "defect"?'),
}


@pytest.mark.parametrize("case", CASES)
def test_it_ends_with_2_and_one_message_and_nothing_is_written(case: str, tmp_path: Path) -> None:
    right, wrong, line, setting, allowed = CASES[case]
    path, out = tmp_path / "recipe.toml", tmp_path / "out"
    path.write_text(GOOD.replace(right, wrong, 1), encoding="utf-8")
    done = run("generate", path, "--out", out)
    assert done.exit_code == 2
    assert done.stderr.startswith(f"error: {path}, line {line}: ")
    assert done.stderr.count("\n") == 1
    assert setting in done.stderr
    assert allowed in done.stderr
    assert run("check", path) == done
    assert list(tmp_path.iterdir()) == [path]


def test_the_recipe_without_mistakes_is_made(tmp_path: Path) -> None:
    path = tmp_path / "recipe.toml"
    path.write_text(GOOD, encoding="utf-8")
    arguments = ["generate", str(path), "--out", str(tmp_path / "out"), "--workers", "1"]
    assert run(*arguments).exit_code == 0


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("pitch_diameter_mm = 1e10", "pitch_diameter_mm = 10000000000.0; allowed: a number from 0.1 to 100000"),
        ("ball_diameter_mm = 1e-300", "ball_diameter_mm = 1e-300; allowed: a number from 0.1 to 100000"),
        ("support_frequency_hz = 1e300", "support_frequency_hz = 1e+300; allowed: a number from 0.001 to 1e+07"),
        ("outer_mass_kg = 1e-300", "outer_mass_kg = 1e-300; allowed: a number from 1e-06 to 1e+07"),
        ("film_damping_us = {uniform = [1e-308, 1e308]}", "allowed: a number from 0 to 1e+06"),
        (f"balls = {'9' * 400}", "a whole number in it is too long: 400 digits"),
        (f"balls = -{'9' * 400}", "a whole number in it is too long: 400 digits"),
        (f"balls = 1{'0' * 300}", "a whole number in it is too long: 301 digits"),
        (f"balls = {'9' * 300}", "part[1].machine.balls"),  # as any other number out of range
        (f"balls = {'9' * 5000}", "a whole number in it has too many digits"),
        (f"balls = 0x{'f' * 5000}", "a whole number in it has too many digits"),
        (f"balls = {'[' * 100_000}", "nested too deeply"),
        (f"balls = {'[' * 300}{']' * 300}", f"part[1].machine.balls = {'[' * 21}...{']' * 21}"),
    ],
)
def test_numbers_beyond_all_machines_are_refused(line: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "recipe.toml").write_text(GOOD.replace("machine.rig", f"machine.{line}\nmachine.rig"))
    done = run("generate", tmp_path, "--out", tmp_path / "out")
    assert (done.exit_code, done.output.count("\n")) == (2, 1)
    assert message in done.output
    assert run("check", tmp_path) == done
    assert not (tmp_path / "out").exists()


def test_a_path_too_long_for_the_system_is_told(tmp_path: Path) -> None:
    done = run("generate", "x" * 5000, "--out", tmp_path / "out")
    assert (done.exit_code, done.output.count("\n")) == (2, 1)
    assert "cannot be read" in done.output


@pytest.mark.parametrize("command", ["generate", "preview"])
def test_a_recipe_that_may_not_be_read_is_named(command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    recipe = tmp_path / "locked.toml"
    recipe.write_text(GOOD)
    allowed = os.access
    monkeypatch.setattr(os, "access", lambda path, *mode: os.fspath(path) != str(recipe) and allowed(path, *mode))
    done = run(command, recipe, "--out", tmp_path / "out.png")
    assert (done.exit_code, done.output.count("\n")) == (2, 1)
    assert f'= "{recipe}": cannot be read for lack of permission; allowed: a file or folder that you may' in done.output
    assert not (tmp_path / "out.png").exists()

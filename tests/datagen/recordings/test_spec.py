from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

from datagen.errors import BadInput
from datagen.recordings.label_table import SETTINGS
from datagen.recordings.settings import RecordingSettings, merged
from datagen.recordings.spec import load_spec, parse_spec

PAGE = (Path(__file__).parents[3] / "docs" / "recordings.md").read_text(encoding="utf-8")


def test_the_example_of_the_page_is_a_spec() -> None:
    text = re.findall(r"^```toml\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)[0]
    spec = parse_spec(tomllib.loads(text), Path("page"), text)
    assert [recording.name for recording in spec.recording] == ["weekly", "acceptance"]


def test_the_page_names_every_setting_of_a_recording() -> None:
    for name in RecordingSettings.model_fields:
        assert f"`{name}`" in PAGE, name


def test_the_header_of_the_pages_table_is_one_of_settings() -> None:
    header = re.findall(r"^```csv\n(.*?)\n", PAGE, re.MULTILINE)[0].split(",")
    assert set(header) <= {"file", *SETTINGS}


def test_upper_settings_replace_lower_ones_and_their_alternatives_and_notes_are_joined() -> None:
    lower = {"speed_rpm": 5.0, "unit": "g", "y": "a", "notes": {"a": 1, "b": 1}}
    assert merged(lower, {"speed_hz": 2.0, "notes": {"b": 2}}) == {
        "speed_hz": 2.0, "unit": "g", "y": "a", "notes": {"a": 1, "b": 2},
    }  # fmt: skip
    assert "y" not in merged(lower, {"channel": ()})
    for axis in ("x", "y"):
        assert merged({"channel": (), "unit": "g"}, {axis: "b"}) == {axis: "b", "unit": "g"}
    assert merged({"y": "a", "unit": "g"}, {"x": "b"}) == {"y": "a", "x": "b", "unit": "g"}
    assert merged({"channel": (), "unit": "g"}, {"x": "b"}) == {"x": "b", "unit": "g"}
    assert merged({"extent_mm": 1.0, "depth_um": 2.0}, {"extent_deg": 3.0}) == {"depth_um": 2.0, "extent_deg": 3.0}
    assert merged(lower, {"channel_name": "DE"})["y"] == "a"
    assert merged(lower | {"channel_name": "DE"}, {"channel": ()}).keys() == {"speed_rpm", "unit", "notes", "channel"}


def test_given_settings_come_in_the_order_in_which_they_are_declared_however_they_are_written() -> None:
    # The names of a set come in another order in every process, and the label provenance would with them.
    said = {
        "load_n": 5.0,
        "unit": "g",
        "speed_rpm": 1500.0,
        "rate_hz": 1e4,
        "y": "a",
        "bearing_id": "b",
        "split": "test",
    }
    given = RecordingSettings.model_validate(said).given()
    assert list(given) == [name for name in RecordingSettings.model_fields if name in said]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("name = 'a'\n", "recording: this setting is missing"),
        ("name = 'a'\nrecording = []\n", "line 2: recording = []; allowed: at least 1"),
        ("name = 'a'\n[[recording]]\nname = 'x'\n", "recording[1].files: no files are named"),
        ("name = 'a'\n[[recording]]\nname='x'\nfiles='a'\n[[recording]]\nname='x'\nfiles='b'\n", 'are called "x"'),
        (
            "name = 'a'\n[[recording]]\nname = 'x'\nfiles = 'a'\nsame_samples = 'keep'\n",
            "recording[1].same_samples: unknown key here; it belongs to the top level, above the first table",
        ),
        (
            "name = 'a'\nunit = 'g'\n[[recording]]\nname = 'x'\nfiles = 'a'\n",
            "line 2: unit: unknown key here; it belongs in [defaults] or in [[recording]]",
        ),
        ("name = 'a'\nlicense = 'x'\n[[recording]]\nname = 'x'\nfiles = 'a'\n", 'unknown key; did you mean "licence"?'),
        ("name = a\n", "not valid TOML"),
        (
            'name = "a"\ntitle = "x\\u001b[31mred"\n[[recording]]\nname = "x"\nfiles = "a"\n',
            "holds the control character U+001B; allowed: text without control characters",
        ),
        (
            'name = "a"\n[[recording]]\nname = "x\\u0007"\nfiles = "a"\n',
            "holds the control character U+0007; allowed: text without control characters",
        ),
        *(
            (f"name = 'a'\n[[recording]]\nname = 'x'\nfiles = 'a'\n{line}\n", message)
            for line, message in (
                ("unit = 'cm/s2'", 'unit = "m/s2" and scale = 0.01'),
                ("unit = 'mg'", 'unit = "g" and scale = 0.001'),
                ("y = 'a'\nchannel = [{name = 'n', y = 'b'}]", "x and y are those of the one channel"),
            )
        ),
    ],
)
def test_a_spec_that_says_too_little_or_too_much_is_refused(text: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text(text)
    with pytest.raises(BadInput) as problem:
        load_spec(tmp_path / "s.toml")
    assert message in str(problem.value)
    assert str(problem.value).startswith(str(tmp_path / "s.toml"))

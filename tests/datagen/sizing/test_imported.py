"""Sizes of recordings that know nothing of ball passes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from typer.testing import CliRunner

from datagen.cli import app
from datagen.recordings.importing import import_recordings
from datagen.recordings.spec import load_spec
from datagen.sizing.score import score_sizes

SPEC = """
name = "mine"
[defaults]
unit = "m/s2"
rate_hz = 20000
speed_rpm = 1200
bearing = "koyo_1205"
[[recording]]
name = "all"
files = "*.npy"
y = "data"
"""


def test_recordings_are_told_sizes_or_not_without_being_scored(tmp_path: Path) -> None:
    generator = np.random.default_rng(2)
    np.save(tmp_path / "noise.npy", generator.standard_normal(20000))
    (tmp_path / "spec.toml").write_text(SPEC)
    import_recordings(load_spec(tmp_path / "spec.toml"), tmp_path / "corpus")
    scores = score_sizes(tmp_path / "corpus", None, True, None)
    assert scores.summary is None
    (only,) = scores.records
    assert not only.known_truth
    assert not only.found
    said = CliRunner().invoke(app, ["size", str(tmp_path / "corpus"), "--out", str(tmp_path / "out")])
    assert said.exit_code == 0
    assert "record 0: no estimate" in said.stdout
    assert (tmp_path / "out" / "estimates.csv").read_text().count("\n") == 2  # a line of names and one record
    assert not (tmp_path / "out" / "size_report.png").exists()

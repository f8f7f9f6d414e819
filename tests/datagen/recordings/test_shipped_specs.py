"""The SPECs that come with spallgen, on small files laid out as the published ones are."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from command_line import run

from datagen.corpus import Corpus
from datagen.inspection.check import check_corpus
from datagen.recordings.label_table import read_label_table
from datagen.recordings.spec_files import find_spec, shipped_specs

FOLDER = Path(__file__).parents[3] / "datasets" / "recordings"


def column(seed: int, size: int = 2400) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal((size, 1))


def imported(name: str, root: Path, out: Path) -> tuple[Corpus, str]:
    done = run("import", name, "--root", root, "--out", out)
    assert done.exit_code == 0, done.stderr
    assert check_corpus(out).problems == ()
    return Corpus(out), done.stderr


@pytest.fixture
def cwru(tmp_path: Path) -> Path:
    """Eight files with the variables of the published ones, some in folders and under the names of mirrors."""
    root = tmp_path / "files"
    files = {
        "97.mat": {"X097_DE_time": column(1), "X097_FE_time": column(2), "X097RPM": np.array([[1796.0]])},
        "98.mat": {"X098_DE_time": column(3), "X098_FE_time": column(4)},
        "99.mat": {"X098_DE_time": column(3), "X099_DE_time": column(5), "X099_FE_time": column(6)},
        "12k/105_0.mat": {"X105_DE_time": column(7), "X105RPM": np.array([[1797.0]])},
        "12k/132@6_2.mat": {"X132_DE_time": column(8), "X132RPM": np.array([[1750.0]])},
        "3004.mat": {"X059_DE_time": column(9)},
        "3005.mat": {"X048_DE_time": column(10)},
        "48k/174.mat": {"X173_DE_time": column(11), "X173RPM": np.array([[1796.0]])},
        "12k_Fan_End_IR007_0_278.mat": {"X278_DE_time": column(13), "X278_FE_time": column(14)},
    }
    for name, variables in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        scipy.io.savemat(root / name, variables)
    return root


def test_files_laid_out_as_the_bearing_data_center_publishes_them_come_in(cwru: Path, tmp_path: Path) -> None:
    corpus, message = imported("cwru", cwru, tmp_path / "corpus")
    # Behind lines of progress, if the machine is slow.
    assert any(line.startswith("152 not found: 100.mat, 106.mat, ") for line in message.splitlines())
    table = corpus.labels.set_index("recording")
    assert list(table.index) == ["97", "98", "99", "105", "132", "3004", "3005", "174", "278"]
    assert table["speed_rpm"].tolist() == [1796, 1772, 1750, 1797, 1750, 1730, 1797, 1796, 1797]
    measured = [name for name in table.index if table["speed_basis"][name] == "measured"]
    assert measured == ["97", "105", "132", "174"]
    assert set(table["rate_hz"][["97", "98", "99", "174"]]) == {48000.0}
    assert set(table["rate_hz"][["105", "132", "3004", "3005", "278"]]) == {12000.0}
    assert table["location"].tolist() == ["none"] * 3 + ["inner", "outer", "inner", "ball", "inner", "inner"]
    assert table["condition"].tolist() == ["healthy"] * 3 + ["line"] * 3 + ["unknown", "line", "line"]
    assert table["extent_mm"]["3004"] == pytest.approx(0.028 * 25.4)
    assert table["channel"].tolist() == ["DE"] * 8 + ["FE"]
    # Orders that the data center publishes for the two bearings.
    assert table["bpfi"]["105"] == pytest.approx(5.4152, abs=1e-4)
    assert table["bpfo"]["278"] == pytest.approx(3.0530, abs=2e-4)
    assert table["bpfi"]["278"] == pytest.approx(4.9469, abs=2e-4)
    assert np.array_equal(corpus.signal(2), (column(5)[:, 0] * 9.80665).astype(np.float32))
    assert np.array_equal(corpus.signal(8), (column(14)[:, 0] * 9.80665).astype(np.float32))
    assert json.loads(corpus.waveform(5, "provenance"))["variables"] == {"y": "X059_DE_time"}


def test_the_tables_list_the_161_files_that_are_published_each_once() -> None:
    tables = {path.stem: read_label_table(path, _notes(path)) for path in sorted(FOLDER.glob("cwru_*.csv"))}
    counts = {name: len(rows) for name, rows in tables.items()}
    assert counts == {"cwru_normal": 4, "cwru_drive_end_12k": 60, "cwru_drive_end_48k": 52, "cwru_fan_end_12k": 45}
    names = [row.settings["recording"] for rows in tables.values() for row in rows]
    assert len(set(names)) == 161
    for rows in tables.values():
        for row in rows:
            assert row.files[0] == f"{row.settings['recording']}.mat"
            speeds = {0: 1797, 1: 1772, 2: 1750, 3: 1730}
            assert row.settings["nominal_speed_rpm"] == speeds[row.settings["notes"]["motor_load_hp"]]


def _notes(path: Path) -> tuple[str, ...]:
    header = path.read_text().splitlines()[0]
    return tuple(name for name in ("motor_load_hp", "fault_clock") if name in header)


def test_files_laid_out_as_the_mfpt_society_publishes_them_come_in(tmp_path: Path) -> None:
    root = tmp_path / "files" / "1 - Three Baseline Conditions"
    root.mkdir(parents=True)
    files = {
        "baseline_1": (97656.0, 270.0),
        "OuterRaceFault_2": (97656.0, 270.0),
        "OuterRaceFault_vload_1": (48828.0, 25.0),
        "InnerRaceFault_vload_7": (48828.0, 300.0),
    }
    for seed, (name, (rate, load)) in enumerate(files.items()):
        held = {"gs": column(seed), "sr": rate, "load": load, "rate": 25.0}
        scipy.io.savemat(root / f"{name}.mat", {"bearing": held})
    corpus, _ = imported("mfpt", tmp_path / "files", tmp_path / "corpus")
    table = corpus.labels
    assert table["recording"].tolist() == list(files)
    assert table["rate_hz"].tolist() == [rate for rate, _ in files.values()]
    # 1 lbf is 4.4482216 N.
    assert table["load_n"].tolist() == pytest.approx([load * 4.4482216 for _, load in files.values()], rel=1e-12)
    assert table["location"].tolist() == ["none", "outer", "outer", "inner"]
    assert table["condition"].tolist() == ["healthy", "unknown", "unknown", "unknown"]
    assert set(zip(table["speed_rpm"], table["speed_basis"], strict=True)) == {(1500.0, "nominal")}
    # The published geometry: 8 balls of 0.235 in on a pitch circle of 1.245 in.
    assert table["bpfo"][0] * 25.0 == pytest.approx(4.0 * 25.0 * (1.0 - 0.235 / 1.245), rel=2e-4)
    assert math.isnan(table["extent_mm"][1])


def test_a_spec_that_comes_with_spallgen_is_found_by_name_after_a_file_of_that_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert set(shipped_specs()) == {"cwru", "mfpt"}
    monkeypatch.chdir(tmp_path)
    assert find_spec("cwru").samefile(FOLDER / "cwru.toml")
    (tmp_path / "cwru").write_text("")
    assert find_spec("cwru") == Path("cwru")

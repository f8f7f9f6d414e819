"""The layouts of the page, each as a few small files of the kind, come in with the settings that the page says."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import scipy.io

from datagen.corpus import Corpus
from datagen.recordings.importing import import_recordings
from datagen.recordings.spec import load_spec

PAGE = (Path(__file__).parents[3] / "docs" / "recordings.md").read_text(encoding="utf-8")
SPEC = re.findall(r"^```toml\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)[1]
GENERATOR = np.random.default_rng(7)


def noise(*shape: int) -> np.ndarray:
    return GENERATOR.standard_normal(shape)


def pulses(rate: int, size: int, per_second: float) -> np.ndarray:
    return np.where((np.arange(size) / rate * per_second + 0.4) % 1.0 < 0.5, 5.0, 0.0)


def write_mat(path: Path, **variables: Any) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    scipy.io.savemat(path, variables)


def write_table(path: Path, table: np.ndarray, delimiter: str = ",", header: str = "") -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    np.savetxt(path, table, "%.6f", delimiter=delimiter, header=header, comments="")


def structures(folder: Path) -> None:
    channels = np.empty((1, 7), dtype=[("Name", object), ("Data", object)])
    for place in range(7):
        channels[0, place] = (f"channel {place}", np.full((1, 40), 900.0) if place == 3 else noise(1, 640))
    write_mat(folder / "KA01/N09_M07_F10_KA01_1.mat", N09_M07_F10_KA01_1={"Y": channels})


def numbered(folder: Path) -> None:
    for bearing in ("Bearing1_1", "Bearing1_2"):
        header = "Horizontal_vibration_signals,Vertical_vibration_signals"
        write_table(folder / f"35Hz12kN/{bearing}/1.csv", noise(64, 2), header=header)


def clocked(folder: Path) -> None:
    for bearing, delimiter in (("Bearing1_1", ","), ("Bearing1_4", ";")):
        table = np.concatenate([np.full((64, 4), 9.0), noise(64, 2)], axis=1)
        write_table(folder / f"Learning_set/{bearing}/acc_00001.csv", table, delimiter)


def dated(folder: Path) -> None:
    write_table(folder / "2nd_test/2004.02.12.10.32.39", noise(64, 4), "\t")


def encoder(folder: Path) -> None:
    encoded = np.concatenate([pulses(200_000, 200_000, 1024.0 * speed) for speed in (15.0, 20.0)])
    write_mat(folder / "H-A-1.mat", Channel_1=noise(400_000, 1), Channel_2=encoded[:, None])


def first_row(folder: Path) -> None:
    table = noise(64, 5)
    table[:, 2] = 0.0
    table[0, 2] = 1770.0
    write_mat(folder / "H_1_0.mat", H_1_0=table)


def tacho(folder: Path) -> None:
    table = np.concatenate([pulses(50_000, 50_000, 12.288)[:, None], noise(50_000, 7)], axis=1)
    write_table(folder / "normal/12.288.csv", table)


def stepped(folder: Path) -> None:
    axis, values = {"increment": 1.0 / 25_600.0, "number_of_values": 64.0}, {"values": noise(64, 4)}
    write_mat(folder / "0Nm_Normal.mat", Signal={"x_values": axis, "y_values": values})


def named(folder: Path) -> None:
    for name in ("ib600_2", "n600_3_2", "ob1000_2"):
        write_table(folder / f"{name}.csv", noise(64, 1))


def titled(folder: Path) -> None:
    (folder / "bearingset").mkdir()
    titles = "".join(f"Title {line}: \xb5\n" for line in range(16))
    for name, delimiter in (("ball_20_0", ","), ("inner_30_2", "\t"), ("comb_30_2", "\t")):
        rows = "".join(delimiter.join(f"{value:.6f}" for value in row) + f"{delimiter}\n" for row in noise(64, 8))
        (folder / f"bearingset/{name}.csv").write_text(titles + rows, encoding="latin-1")


def misnamed(folder: Path) -> None:
    titles = "".join(f"Title {line}: \xb5\tV\n" for line in range(21)) + "Data\n"
    for name in ("0.5X_I_40Hz", "H_20Hz", "O_80Hz", "I_VS_0_40_0Hz"):
        rows = "".join("\t".join(f"{value:.6f}" for value in row) + "\n" for row in noise(64, 5))
        (folder / f"{name}.xls").write_text(titles + rows, encoding="latin-1")


def labview(folder: Path) -> None:
    end = "***End_of_Header***\t\t\n"
    head = "LabVIEW Measurement\t\n" + "Operator\tM\xfcller\n" * 10 + f"{end}\t\n" + "X0\t0,0E+0\t\n" * 8 + end
    rows = "".join(f"{k / 8000:.6f}\t{value:.6f}\t\n" for k, value in enumerate(noise(64))).replace(".", ",")
    (folder / "run.lvm").write_text(f"{head}X_Value\tUntitled\tComment\n{rows}", encoding="latin-1")


def exported(folder: Path) -> None:
    rows = "".join(f"{k / 8000:.6f};{value:.6f};\r\n" for k, value in enumerate(noise(64)))
    (folder / "export").mkdir()
    text = "Zeit;Kanal 1\r\ns;m/s²\r\n" + rows.replace(".", ",")
    (folder / "export/1.txt").write_text(text, encoding="latin-1", newline="")


def stacked(folder: Path) -> None:
    np.savez(folder / "pack.npz", signals=noise(2, 64), labels=[1, 2])
    head, row = re.findall(r"^table = \"stacked.csv\" *# (.*)\n *# (.*)$", SPEC, re.MULTILINE)[0]
    second = row.replace("0", "1").replace("inner", "outer")
    (folder / "stacked.csv").write_text(f"{head}\n{row}\n{second}\n")


@pytest.fixture(scope="module")
def corpus(tmp_path_factory: pytest.TempPathFactory) -> Corpus:
    """The records of all layouts."""
    folder = tmp_path_factory.mktemp("layouts")
    for write in (
        structures, numbered, clocked, dated, encoder, first_row, tacho, stepped, named, titled, misnamed, labview,
        exported, stacked,
    ):  # fmt: skip
        write(folder)
    (folder / "layouts.toml").write_text(SPEC, encoding="utf-8")
    import_recordings(load_spec(folder / "layouts.toml"), folder / "out")
    return Corpus(folder / "out")


@pytest.fixture(scope="module")
def labels(corpus: Corpus) -> pd.DataFrame:
    """The labels of all layouts, by part."""
    return corpus.labels.set_index("part")


EXPECTED: dict[str, tuple[list[str], float, list[float]]] = {
    "structures": (["KA01/N09_M07_F10_KA01_1"], 64000.0, [900.0]),
    "numbered": (
        [f"35Hz12kN/Bearing1_{bearing}/1 {axis}" for bearing in (1, 2) for axis in ("horizontal", "vertical")],
        25600.0,
        [2100.0] * 4,
    ),
    "clocked": ([f"Learning_set/{name}/acc_00001" for name in ("Bearing1_1", "Bearing1_4")], 25600.0, [1800.0] * 2),
    "dated": ([f"2nd_test/2004.02.12.10.32.39 B{k}" for k in (1, 2, 3, 4)], 20480.0, [2000.0] * 4),
    "encoder": (["H-A-1"], 200000.0, [1050.0]),
    "first_row": (["H_1_0"], 42000.0, [1770.0]),
    "tacho": (["normal/12.288 underhang", "normal/12.288 overhang"], 50000.0, [737.28] * 2),
    "stepped": (["0Nm_Normal"], 25600.0, [3010.0]),
    "named": (["ib600_2", "ob1000_2", "n600_3_2"], 50000.0, [600.0, 1000.0, 600.0]),
    "titled": (["bearingset/ball_20_0", "bearingset/inner_30_2"], 5120.0, [1200.0, 1800.0]),
    "misnamed": (["0.5X_I_40Hz", "H_20Hz", "O_80Hz"], 25600.0, [2400.0, 1200.0, 4800.0]),
    "labview": (["run"], 8000.0, [1480.0]),
    "exported": (["export/1"], 8000.0, [1480.0]),
    "stacked": (["pack row 0", "pack row 1"], 12000.0, [1797.0] * 2),
}


@pytest.mark.parametrize("part", EXPECTED)
def test_a_layout_of_the_page_comes_in_with_its_names_rate_and_speed(part: str, labels: pd.DataFrame) -> None:
    names, rate, speeds = EXPECTED[part]
    found = labels.loc[[part]]
    assert found["recording"].tolist() == names
    assert found["rate_hz"].unique().tolist() == [rate]
    assert found["speed_rpm"].tolist() == pytest.approx(speeds, rel=1e-3)


def test_a_set_point_of_the_speed_is_not_called_measured(labels: pd.DataFrame) -> None:
    for part in ("numbered", "clocked", "dated", "stepped", "named"):
        assert set(labels.loc[[part], "speed_basis"]) == {"nominal"}


def test_the_page_shows_as_many_layouts_as_are_tried(labels: pd.DataFrame) -> None:
    assert set(labels.index) == set(EXPECTED) == set(re.findall(r'^name = "(\w+)"$', SPEC, re.MULTILINE)) - {"layouts"}


def test_what_is_defective_is_told_by_a_name_or_a_table(labels: pd.DataFrame) -> None:
    assert labels.loc["named", "location"].tolist() == ["inner", "outer", "none"]
    assert labels.loc["misnamed", "location"].tolist() == ["inner", "none", "outer"]
    assert labels.loc["stacked", "location"].tolist() == ["inner", "outer"]


def test_bearings_are_told_apart_by_folder_and_channel(labels: pd.DataFrame) -> None:
    assert labels.loc["clocked", "bearing_id"].tolist() == ["Bearing1_1", "Bearing1_4"]
    assert labels.loc["dated", "bearing_id"].tolist() == [f"2nd_test B{number}" for number in (1, 2, 3, 4)]


def test_of_a_speed_that_changes_the_angle_is_kept(corpus: Corpus, labels: pd.DataFrame) -> None:
    angle = corpus.waveform(int(labels.loc["encoder", "record"]), "shaft_angle") / (2.0 * np.pi)
    # 15 turns in the first second, 20 in the second; where the speed jumps a few thousandths of a turn may be lost.
    assert np.interp([0.5, 1.0, 1.5], np.arange(400_000) / 200_000, angle) == pytest.approx([7.5, 15.0, 25.0], abs=0.01)
    assert not corpus.has(int(labels.loc["first_row", "record"]), "shaft_angle")

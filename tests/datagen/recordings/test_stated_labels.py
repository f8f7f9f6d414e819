"""What a SPEC and its tables say of recordings, and which of them goes before the other."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from imports import SPEC, Bring, Mat, noise

from datagen.errors import BadInput
from datagen.files.digest import file_hash
from datagen.inspection.info import corpus_info

G = 9.80665


def as_stored(samples: np.ndarray, factor: float) -> np.ndarray:
    """What float64 numbers times their scale are as stored: float32, shown as float64."""
    return (samples * factor).astype(np.float32).astype(np.float64)


def test_tables_of_one_name_in_two_folders_are_both_told_of(bring: Bring, tmp_path: Path) -> None:
    text = '[defaults]\nunit = "g"\nrate_hz = 12000\ny = "data"\n'
    for name, samples in {"a": 400, "b": 401}.items():
        (tmp_path / name).mkdir()
        np.save(tmp_path / name / f"{name}.npy", noise(samples))
        (tmp_path / name / "t.csv").write_text(f"file,location\n{name}/{name}.npy,inner\n")
        text += f'[[recording]]\nname = "{name}"\ntable = "{name}/t.csv"\n'
    assert set(bring(text).manifest.recipe["tables"]) == {"a/t.csv", "b/t.csv"}


@pytest.mark.parametrize("quote", ["", '"'])
@pytest.mark.parametrize(("sign", "encoding"), [(";", "utf-8-sig"), ("\t", "utf-8")])
def test_a_label_table_with_decimal_commas_says_the_same(
    sign: str, encoding: str, quote: str, bring: Bring, tmp_path: Path
) -> None:
    np.save(tmp_path / "a.npy", noise(400).reshape(200, 2))
    (tmp_path / "t.csv").write_text(
        sign.join(f"{quote}{name}{quote}" for name in ("file", "y", "extent_mm", "location", "speed_rpm", "hp"))
        + "\r\n" + sign.join(("a.npy", "data[:,1]", "0,178", "inner", "1796,5", "1,5")),
        encoding=encoding, newline="",
    )  # fmt: skip
    corpus = bring(
        '[[recording]]\nname = "all"\ntable = "t.csv"\nunit = "g"\nrate_hz = 12000\nbearing = "skf_6205"\n'
        'note_columns = ["hp"]\n'
    )
    assert np.array_equal(corpus.signal(0), as_stored(noise(400).reshape(200, 2)[:, 1], G))
    assert corpus.labels["speed_rpm"].tolist() == [1796.5]
    assert corpus.labels["extent"][0] == pytest.approx(0.178 / 15.55, rel=1e-12)
    assert json.loads(corpus.waveform(0, "provenance"))["notes"] == {"hp": 1.5}


def test_a_name_whose_figures_are_joined_is_no_number(bring: Bring, tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", noise(400))
    (tmp_path / "t.csv").write_text("file,y,code,count\na.npy,data,105_2,1052\n")
    corpus = bring(
        '[[recording]]\nname = "all"\ntable = "t.csv"\nunit = "g"\nrate_hz = 12000\nspeed_rpm = 1800\n'
        'bearing = "skf_6205"\nnote_columns = ["code", "count"]\n'
    )
    assert '"notes": {"code": "105_2", "count": 1052}' in corpus.waveform(0, "provenance")


@pytest.mark.parametrize(
    ("law", "parameters"),
    [
        ("", {}),
        (", load_deflection_n_per_m_to_n = 4e8, exponent = 1.11", {"K": 4e8, "n": 1.11}),
        (", load_deflection_n_per_m_to_n = 5e9", {"K": 5e9, "n": 1.5}),
    ],
)
def test_the_contact_law_that_the_spec_states_is_kept_with_the_record(
    law: str, parameters: dict[str, float], bring: Bring, mat: Mat
) -> None:
    mat("a.mat")
    bearing = f"bearing = {{balls = 12, rows = 2, pitch_diameter_mm = 38.75, ball_diameter_mm = 7.12{law}}}\n"
    spec = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    corpus = bring(spec + bearing)
    assert json.loads(corpus.waveform(0, "provenance"))["parameters"] == parameters
    assert corpus.labels[["balls", "rows"]].to_numpy().tolist() == [[12, 2]]


def test_load_and_signal_to_noise_ratio_are_stored_as_they_are_said(bring: Bring, mat: Mat) -> None:
    mat("a.mat")
    spec = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    labels = bring(spec + "load_n = 250\nsnr_db = -4\n").labels
    assert labels[["load_n", "snr_db"]].to_numpy().tolist() == [[250.0, -4.0]]


def test_a_defect_as_long_as_the_ball_spacing_is_extended(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    arcs = {"a": 39.9, "b": 40, "c": 40.1}  # nine balls are 40 degrees apart
    for name in arcs:
        mat(f"{name}.mat")
    rows = "".join(f"{name}.mat,{arc}\n" for name, arc in arcs.items())
    (tmp_path / "t.csv").write_text(f"file,extent_deg\n{rows}")
    known = 'unit = "g"\nrate_hz = 1000\ny = "sig"\nbearing = "skf_6205"\nlocation = "outer"\n'
    labels = bring(f'[[recording]]\nname = "all"\ntable = "t.csv"\n{known}').labels
    assert labels["condition"].tolist() == ["line", "extended", "extended"]


@pytest.mark.parametrize(
    ("said", "condition"),
    [
        ('condition = "extended"', "extended"),
        ('condition = "line"\nextent_mm = 1', "line"),  # of unknown spacing
        ('condition = "line"\nextent_mm = 1\nbearing = "skf_6205"', "line"),
        ('extent_mm = 1\nbearing = "skf_6205"', "line"),
        ("extent_mm = 1", "unknown"),
    ],
)
def test_a_stated_condition_stands_where_no_extent_tells_it(said: str, condition: str, bring: Bring, mat: Mat) -> None:
    mat("a.mat")
    labels = bring(f'{SPEC}location = "outer"\n{said}\n').labels
    assert labels[["condition", "location"]].to_numpy().tolist() == [[condition, "outer"]]


def test_another_table_of_labels_makes_another_corpus(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    found = []
    for load in (100, 200):
        (tmp_path / "t.csv").write_text(f"file,load_n\na.mat,{load}\n")
        found.append(
            bring('[[recording]]\nname = "all"\ntable = "t.csv"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n', str(load))
        )
        assert found[-1].manifest.recipe["tables"] == {"t.csv": file_hash(tmp_path / "t.csv")}
    one, other = (corpus.manifest.identity.recipe_hash for corpus in found)
    assert one != other


def test_overrides_go_before_tables_and_tables_before_the_rest(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    for name in ("r1.mat", "sub/r2.mat", "sub/r3.mat"):
        mat(name)
    (tmp_path / "t.csv").write_text("file,location,bearing_id\nr1.mat,outer,x\nsub/r2.mat,,y\nr3.mat,ball,\n")
    corpus = bring(
        '[defaults]\nunit = "g"\nrate_hz = 1000\nrig = "mill"\n'
        '[[recording]]\nname = "all"\nfiles = "**/*.mat"\ntable = "t.csv"\ny = "sig"\nlocation = "inner"\n'
        'override = [{files = "sub/*", rig = "fan"}, {files = ["r3.mat"], notes = {odd = true}}]\n'
    )
    table = corpus.labels
    assert table["location"].tolist() == ["outer", "inner", "ball"]
    assert table["rig"].tolist() == ["mill", "fan", "fan"]
    assert table["bearing_id"].tolist() == ["x", "y", "unknown"]
    assert corpus_info(corpus.folder).bearings_text == "2 (unknown 2); 1 record of unknown ones"
    assert json.loads(corpus.waveform(2, "provenance"))["notes"] == {"odd": True}


def test_a_size_of_nothing_in_a_label_table_is_that_of_a_healthy_bearing(
    bring: Bring, mat: Mat, tmp_path: Path
) -> None:
    for name in ("a.mat", "b.mat"):
        mat(name)
    spec = '[[recording]]\nname = "all"\ntable = "t.csv"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    (tmp_path / "t.csv").write_text("file,location,extent_mm,depth_um\na.mat,none,0,0.0\nb.mat,outer,1.5,\n")
    labels = bring(spec).labels
    assert labels["condition"].tolist() == ["healthy", "unknown"]
    assert labels["extent_mm"].tolist() == [0.0, 1.5]
    shutil.rmtree(tmp_path / "corpus")
    (tmp_path / "t.csv").write_text("file,location,extent_mm\na.mat,none,0\nb.mat,outer,0\n")
    with pytest.raises(BadInput, match=r"t\.csv, line 3: extent_mm = 0"):
        bring(spec)


def test_a_speed_of_a_label_table_goes_before_that_of_the_spec(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    for name in ("a.mat", "b.mat"):
        mat(name)
    (tmp_path / "t.csv").write_text("file,speed_rpm\na.mat,1200\nb.mat,\n")
    text = '[[recording]]\nname = "all"\ntable = "t.csv"\nunit = "g"\nrate_hz = 1000\ny = "sig"\nspeed_hz = 30\n'
    assert bring(text).labels["speed_rpm"].tolist() == [1200.0, 1800.0]


def test_a_label_table_may_hold_the_numbers_of_every_bearing(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    for name in ("a.mat", "b.mat"):
        mat(name, slow=np.full((50, 1), 600.0))
    (tmp_path / "t.csv").write_text(
        "file,bearing,speed_rpm,y\n"
        'a.mat,"{balls = 9, ball_diameter_mm = 7.94, pitch_diameter_mm = 39.04}",{variable = "slow"},sig\n'
        "b.mat,skf_6205,1797,sig\n"
    )
    labels = bring('[[recording]]\nname = "all"\ntable = "t.csv"\nunit = "g"\nrate_hz = 1000\n').labels
    assert labels["balls"].tolist() == [9, 9]
    assert labels["ball_diameter"][0] == pytest.approx(7.94e-3)
    assert labels["speed_rpm"].tolist() == [600.0, 1797.0]


def test_an_override_of_one_axis_leaves_the_other(bring: Bring, mat: Mat) -> None:
    for name in ("a.mat", "b.mat"):
        mat(name, other=noise(seed=5)[:, None], third=noise(seed=6)[:, None])
    corpus = bring(
        '[defaults]\nunit = "g"\nrate_hz = 1000\n[[recording]]\nname = "all"\nfiles = "*.mat"\nx = "sig"\ny = "other"\n'
        'override = [{files = "b*", y = "third"}]\n'
    )
    assert [corpus.waveform(record, "acceleration").shape[-1] for record in (0, 1)] == [2, 2]
    plain, changed = (corpus.waveform(record, "acceleration")[:, 1] for record in (0, 1))
    assert np.corrcoef(plain, noise(seed=5))[0, 1] == pytest.approx(1.0)
    assert np.corrcoef(changed, noise(seed=6))[0, 1] == pytest.approx(1.0)


@pytest.mark.parametrize("column", ["speed_rpm", "file", "location"])
def test_no_column_that_says_something_else_is_a_note(column: str, bring: Bring, mat: Mat, tmp_path: Path) -> None:
    mat("a.mat")
    (tmp_path / "t.csv").write_text("file,speed_rpm,location\na.mat,3000,outer\n")
    with pytest.raises(BadInput, match=f'"{column}" is a column that says something else, and is never a note'):
        bring(
            '[[recording]]\nname = "all"\ntable = "t.csv"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
            f'note_columns = ["{column}"]\n'
        )


def test_geometry_and_size_are_stored_in_si_units_and_give_the_published_orders(bring: Bring, mat: Mat) -> None:
    mat("a.mat")
    labels = bring(
        '[[recording]]\nname = "all"\nfiles = "*.mat"\nunit = "g"\nrate_hz = 6000\ny = "sig"\nspeed_rpm = 2000\n'
        "bearing = {balls = 16, pitch_diameter_mm = 71.5, ball_diameter_mm = 8.407, contact_angle_deg = 15.17}\n"
        'location = "inner"\nextent_deg = 6\ndepth_um = 12\n'
    ).labels.iloc[0]
    stored = labels[["pitch_diameter", "ball_diameter", "contact_angle", "depth", "extent", "extent_spacing"]].tolist()
    # Radians of 15.17 and of 6 degrees; 6 degrees of 360 / 16.
    assert stored == pytest.approx([0.0715, 0.008407, 0.264766, 12e-6, 0.1047198, 6.0 / 22.5], rel=2e-6)
    # Along an inner race of (71.5 - 8.407 cos 15.17°) / 2 = 31.693 mm.
    assert labels["extent_mm"] == pytest.approx(31.693 * 0.1047198, rel=2e-5)
    # Published with the ZA-2115 of IMS at 2000 rpm, Hz; without its contact angle BPFO would be 235.3 Hz.
    assert labels["bpfo"] * 2000.0 / 60.0 == pytest.approx(236.4, abs=0.05)
    assert labels["bpfi"] * 2000.0 / 60.0 == pytest.approx(296.9, abs=0.05)


def test_a_table_may_name_a_file_outside_the_root(bring: Bring, mat: Mat, tmp_path: Path) -> None:
    samples = mat("elsewhere/a.mat")
    (tmp_path / "inside").mkdir()
    (tmp_path / "t.csv").write_text(f"file\n{tmp_path}/elsewhere/a.mat\n")
    corpus = bring(
        'root = "inside"\n[[recording]]\nname = "all"\nunit = "m/s2"\nrate_hz = 1000\ny = "sig"\ntable = "t.csv"\n'
    )
    assert corpus.labels["source_file"][0] == f"{tmp_path}/elsewhere/a.mat"
    assert np.array_equal(corpus.signal(0), as_stored(samples, 1.0))

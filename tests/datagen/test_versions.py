"""What a measured speed is said to belong to."""

import os

import pytest

from datagen import versions
from physics.compiled import fingerprint


@pytest.fixture
def cpu_info(tmp_path, monkeypatch):
    """Function (text or None) that puts this text in the place of /proc/cpuinfo; None: there is none."""

    def put(text):
        path = tmp_path / "cpuinfo"
        if text is not None:
            path.write_text(text, encoding="utf-8")
        monkeypatch.setattr(versions, "CPU_INFO", path)
        return versions.processor_name()

    return put


def test_the_processor_is_named_by_its_model(cpu_info):
    text = (
        "processor\t: 0\nvendor_id\t: Maker\nmodel\t\t: 1\nmodel name\t: Maker Fast: 9 @ 3.0 GHz\nmodel name\t: other\n"
    )
    assert cpu_info(text) == "Maker Fast: 9 @ 3.0 GHz"


@pytest.mark.parametrize("text", [None, "", "model name\t: \n", "Hardware\t: board\n"])
def test_where_no_model_is_told_the_kind_of_processor_is(text, cpu_info, monkeypatch):
    monkeypatch.setattr(versions.platform, "processor", lambda: "")
    monkeypatch.setattr(versions.platform, "machine", lambda: "riscv64")
    assert cpu_info(text) == "riscv64"
    monkeypatch.setattr(versions.platform, "processor", lambda: "some kind")
    assert cpu_info(text) == "some kind"


def test_a_measurement_is_told_with_its_processor_cores_physics_and_packages():
    made = versions.measured_on("numpy", "numba")
    assert made["processor"] == versions.processor_name()
    assert (made["cores"], made["physics"]) == (str(os.cpu_count()), fingerprint())
    assert list(made)[-3:] == ["python", "numpy", "numba"]


def test_the_same_in_words_leaves_nothing_out():
    made = versions.measured_on("numpy")
    words = versions.in_words(made)
    assert all(value in words for value in made.values())
    assert f"numpy {made['numpy']}" in words

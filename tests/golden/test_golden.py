"""What records, features and sizes were when they were last pinned; the script that pins them anew."""

from __future__ import annotations

import json
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

import pytest

HERE = Path(__file__).parent


@pytest.fixture(scope="module")
def golden() -> ModuleType:
    """The script, its numbers made once."""
    spec = spec_from_file_location("regenerate", HERE / "regenerate.py")
    assert spec is not None
    assert spec.loader is not None
    script = module_from_spec(spec)
    spec.loader.exec_module(script)
    found = script.numbers()
    script.numbers = lambda: found
    return script


def test_records_features_and_sizes_are_as_pinned(golden: ModuleType, capsys: pytest.CaptureFixture[str]) -> None:
    status = golden.main(["--dry-run"])
    assert capsys.readouterr().out == ""
    assert status == 0


def test_a_dry_run_tells_what_differs_and_writes_nothing(
    golden: ModuleType, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pinned = json.loads(golden.FILE.read_text())
    pinned["quickstart 0"]["rms_m_s2 y"] *= 1.003  # promised to 0.2 %
    pinned["quickstart 0"]["features kurtosis"] += 0.005  # within its hundredth
    del pinned["quickstart 46"]["release_s 0"]
    pinned["corpus 6"]["loudness"] = 1.0
    file = tmp_path / "records.json"
    file.write_text(before := json.dumps(pinned))
    assert golden.main(["--dry-run"], file) == 1
    printed = capsys.readouterr().out.splitlines()
    assert [" ".join(line.split()[:4]) for line in printed] == [
        "corpus 6: loudness is",
        "quickstart 0: rms_m_s2 y",
        "quickstart 46: release_s 0",
    ]
    assert file.read_text() == before


def test_regenerated_numbers_pass_the_next_dry_run(golden: ModuleType, tmp_path: Path) -> None:
    file = tmp_path / "records.json"
    assert golden.main([], file) == 0
    assert golden.main(["--dry-run"], file) == 0
    assert json.loads(file.read_text()).keys() == json.loads(golden.FILE.read_text()).keys()

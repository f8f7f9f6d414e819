"""The imports of docs/transfer.md run as they stand there, on small files laid out as the published ones are."""

from __future__ import annotations

import re
import shlex
import subprocess
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from command_line import run

from datagen.corpus import Corpus

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "transfer.md").read_text(encoding="utf-8")
SPECS = re.findall(r'^```toml\n(name = "(\w+)"\n.*?)^```$', PAGE, re.MULTILINE | re.DOTALL)
(SCRIPT,) = re.findall(r"^```bash\n(spallgen generate .*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
GENERATOR = np.random.default_rng(11)
# Name of the variables of files whose number is another one.
CALLED = {"174": "173", "3001": "056", "3002": "057", "3003": "058", "3004": "059", "3005": "048", "3006": "049"}
CALLED |= {"3007": "050", "3008": "051"}
FIRST_TEST = [f"2003.10.22.{hour}.{minute}.13" for hour in (12, 13, 14) for minute in (14, 34, 54)]
FIRST_TEST += ["2003.10.22.15.14.13", "2003.10.22.15.37.48"]
LATER_TESTS = {
    "2nd_test": ["2004.02.12.10.32.39", "2004.02.12.10.42.39", "2004.02.19.06.22.39"],
    "4th_test/txt": ["2004.04.18.02.42.55"],
}
NOT_SCORED = {"1st_test": ["2003.10.22.12.09.13", "2003.10.22.15.34.13"], "2nd_test": ["2004.02.12.10.52.39"]}


def noise(*shape: int) -> np.ndarray:
    return GENERATOR.standard_normal(shape)


def write_cwru(folder: Path, numbers: list[str]) -> None:
    folder.mkdir(parents=True)
    for number in numbers:
        name = f"X{CALLED.get(number, number.zfill(3))}"
        variables = {f"{name}_DE_time": noise(4800, 1)}
        if len(number) < 4:
            variables |= {f"{name}_FE_time": noise(4800, 1), f"{name}RPM": np.array([[1790.0]])}
        scipy.io.savemat(folder / f"{number}.mat", variables)


def write_mfpt(folder: Path) -> None:
    folder.mkdir(parents=True)
    names = [f"baseline_{k}" for k in (1, 2, 3)] + [f"OuterRaceFault_{k}" for k in (1, 2, 3)]
    names += [f"{race}RaceFault_vload_{k}" for race in ("Outer", "Inner") for k in range(1, 8)]
    for name in names:
        held = {"gs": noise(4800, 1), "sr": 48828.0, "load": 270.0, "rate": 25.0}
        scipy.io.savemat(folder / f"{name}.mat", {"bearing": held})


def write_ims(root: Path) -> None:
    for folder, names in [("1st_test", FIRST_TEST), *LATER_TESTS.items(), *NOT_SCORED.items()]:
        (root / folder).mkdir(parents=True, exist_ok=True)
        for name in names:
            table = noise(3000, 8 if folder == "1st_test" else 4)
            np.savetxt(root / folder / name, table, "%.3f", delimiter="\t")


def rows_of(text: str) -> list[str]:
    return [line.split(",")[1] for line in text.splitlines()[1:]]


@pytest.fixture(scope="module")
def corpora(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Corpus]:
    """The imported corpora of the page, by the names of their folders."""
    here = tmp_path_factory.mktemp("scored")
    table = (ROOT / "datasets" / "recordings" / "cwru_drive_end_12k.csv").read_text(encoding="utf-8")
    write_cwru(here / "cwru" / "de12k", rows_of(table))
    (listed,) = re.findall(r"^\| `cwru_48k` .*with the files ([\d, ]+) \|$", PAGE, re.MULTILINE)
    write_cwru(here / "cwru" / "48k", listed.split(", "))
    write_mfpt(here / "mfpt")
    write_ims(here / "ims")
    (here / "datasets").symlink_to(ROOT / "datasets", target_is_directory=True)
    for text, name in SPECS:
        (here / f"{name.removeprefix('cwru_')}.toml").write_text(text, encoding="utf-8")
    found = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(here)
        for line in SCRIPT.splitlines():
            if line.startswith("grep "):
                subprocess.run(line, shell=True, check=True)
            elif line.startswith("spallgen import "):
                arguments = shlex.split(line.replace("~", str(here)))[1:]
                done = run(*arguments)
                assert done.exit_code == 0, done.output
                found[Path(arguments[-1]).name] = Corpus(here / arguments[-1])
    return found


def test_each_has_as_many_records_of_each_kind_as_the_page_says(corpora: dict[str, Corpus]) -> None:
    assert {name: corpus.labels["location"].value_counts().to_dict() for name, corpus in corpora.items()} == {
        "cwru_de12k": {"inner": 16, "outer": 28, "ball": 16},
        "cwru_48k": {"inner": 3, "outer": 7, "ball": 3, "none": 1},
        "cwru_fe12k": {"inner": 12, "outer": 28, "ball": 12},
        "mfpt": {"none": 3, "inner": 7, "outer": 10},
        "ims_healthy": {"none": 96, "unknown": 8},
    }


def test_rates_sensors_and_speeds_are_those_of_the_recordings(corpora: dict[str, Corpus]) -> None:
    for name, rate in {"cwru_de12k": 12000, "cwru_48k": 48000, "cwru_fe12k": 12000, "ims_healthy": 20480}.items():
        assert set(corpora[name].labels["rate_hz"]) == {rate}
    assert set(corpora["cwru_fe12k"].labels["channel"]) == {"FE"}
    assert set(corpora["cwru_fe12k"].labels["speed_rpm"]) == {1790.0}
    early = corpora["ims_healthy"].labels
    assert set(early["speed_basis"]) == {"nominal"}
    assert early[early["location"] == "none"]["bearing_id"].nunique() == 8  # four of either test

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from command_line import run

from datagen.commands.tables import catalog_tables
from datagen.corpus_files.index import read_index
from datagen.files.plain import plain_json
from datagen.versions import program_versions

ROOT = Path(__file__).parents[2]
COMMANDS = (
    "generate",
    "import",
    "check",
    "info",
    "preview",
    "report",
    "paper",
    "chart",
    "features",
    "classify",
    "size",
    "catalog",
    "schema",
)
BUFFERED = {**os.environ, "PYTHONUNBUFFERED": ""}
HEAVY = ("numpy", "numba", "xarray", "scipy", "pandas", "netCDF4", "pydantic", "joblib", "matplotlib", "rich")


def test_an_encoding_that_lacks_letters_ends_no_command() -> None:
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    words = [sys.executable, "-m", "datagen", "catalog"]
    done = subprocess.run(words, cwd=ROOT, env=environment, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert "?" in done.stdout


def test_help_imports_nothing_heavy() -> None:
    script = (
        "import sys; sys.argv = ['spallgen', '--help']\n"
        "from datagen.cli import main\n"
        "try: main()\n"
        f"except SystemExit: print('HEAVY', [name for name in {HEAVY} if name in sys.modules])\n"
    )
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.endswith("HEAVY []\n")


def test_the_module_runs_as_the_command() -> None:
    done = subprocess.run([sys.executable, "-m", "datagen", "--help"], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0
    assert all(command in done.stdout for command in COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_shows_an_example_and_takes_json(command: str) -> None:
    code, shown, _ = run(command, "--help")
    assert code == 0
    assert f"Example: spallgen {command}" in shown
    assert "--json FILE" in shown


def test_the_help_of_classify_names_every_kind_of_training_set() -> None:
    _, shown, _ = run("classify", "--help")
    message = "".join(shown.split())  # lines end at blanks and behind hyphens
    for kind in ("Simulatedcorpus", "afilethat--savewrote", "impulse-trains,", "impulse-trains-without-INGREDIENT"):
        assert kind in message


def test_generate_check_and_info_work_and_write_their_results(tiny_recipe: Path, tmp_path: Path) -> None:
    out, results = tmp_path / "out", tmp_path / "results.json"
    code, shown, message = run("generate", tiny_recipe, "--out", out, "--limit", 3, "--workers", 1, "--json", results)
    assert code == 0, message
    assert f"3 of 3 records are in {out}" in shown
    assert json.loads(results.read_text())["made"] == 3
    code, shown, _ = run("check", out, "--json", results)
    assert code == 0
    assert "3 records in" in shown
    assert "sound" in shown
    assert json.loads(results.read_text())["problems"] == []
    code, shown, _ = run("info", out, "--json", results)
    assert code == 0
    assert "gearbox 3" in shown
    assert json.loads(results.read_text())["counts"]["rig"] == {"gearbox": 3}


def test_a_limit_beyond_the_recipe_is_told(tiny_recipe: Path, tmp_path: Path) -> None:
    code, shown, message = run("generate", tiny_recipe, "--out", tmp_path / "out", "--limit", 99, "--workers", 1)
    assert code == 0
    assert "14 of 14 records" in shown
    assert "--limit 99: the recipe has no more than 14 records" in message


def test_check_ends_with_1_and_says_what_is_wrong(tiny_recipe: Path, tmp_path: Path) -> None:
    run("generate", tiny_recipe, "--out", tmp_path / "out", "--records", "1", "--workers", 1)
    shard = next((tmp_path / "out" / "shards").glob("*.nc"))
    shard.write_bytes(shard.read_bytes()[:-7])
    code, shown, message = run("check", tmp_path / "out")
    assert code == 1
    assert "NOT sound" in shown
    assert f"{shard.name}: its bytes have changed" in message


def test_the_catalogue_gives_every_number_with_its_source(tmp_path: Path) -> None:
    code, shown, _ = run("catalog", "--json", tmp_path / "c.json")
    assert code == 0
    assert "rig gearbox" in shown
    rows = json.loads((tmp_path / "c.json").read_text())
    assert all(row["source"] for row in rows)
    assert any(row["quantity"] == "resonator_mass" and row["value"] == 0.5 for row in rows)
    sources = [str(cell) for table in catalog_tables() for cell in table.columns[3].cells]
    guessed = [row["assumed"] and row["source"] != "assumed" for row in rows]
    assert [source.endswith(" (assumed)") for source in sources] == guessed


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("generate", "RECIPE"), "--out"),
        (("generate", "RECIPE", "--out", "OUT", "--limit", "0"), "--limit = 0"),
        (("generate", "RECIPE", "--out", "OUT", "--limit", "x"), "--limit"),
        (("generate", "RECIPE", "--out", "OUT", "--records", "1,b"), "--records"),
        (
            ("generate", "RECIPE", "--out", "OUT", "--records", "1,2,1"),
            "1 is listed more than once; allowed: each record once",
        ),
        (("generate", "RECIPE", "--out", "OUT", "--records", "99"), "0 to 13"),
        (("generate", "RECIPE", "--out", "OUT", "--workers", "0"), "--workers = 0"),
        (("generate", "RECIPE", "--out", "OUT", "--backend", "ray"), "loky, dask"),
        (("features", "RECIPE", "--out", "OUT", "--workers", "9999"), "a whole number from 1 to 1024"),
        (("size", "RECIPE", "--workers", "9999"), "a whole number from 1 to 1024"),
        (("classify", "--train", "RECIPE", "--workers", "9999"), "a whole number from 1 to 1024"),
        (("generate", "nowhere.toml", "--out", "OUT"), "nowhere.toml"),
        (("generate", "RECIPE", "--out", "OUT", "--limt", "3"), "--limit"),
        (("check", "OUT"), "no such file or folder, and no dataset of that name"),
        (("info", "OUT"), "no such folder"),
        (("preview", "RECIPE", "--record", "99", "--out", "x.png"), "0 to 13"),
        (("frobnicate",), "frobnicate"),
    ],
)
def test_bad_input_ends_with_2_and_one_clear_message_and_writes_nothing(
    arguments: tuple[str, ...], words: str, tiny_recipe: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    places = {"RECIPE": str(tiny_recipe), "OUT": str(tmp_path / "out")}
    code, _, message = run(*(places.get(argument, argument) for argument in arguments))
    assert code == 2, message
    assert words in message
    assert "Traceback" not in message
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("frobnicate", "frobnicate: there is no such command; allowed: catalog, chart, check,"),
        ("generat", 'generat: there is no such command, did you mean "generate"?; allowed: '),
        ("--bogus", "--bogus: there is no such option; allowed: --version, --help"),
        ("--version=3", "--version: this option takes no value; allowed: --version"),
        ("generate", "RECIPE: it must be given; allowed: RECIPE: Recipe file, its folder, or name of a dataset"),
        ("generate a", "--out: it must be given; allowed: --out DIR: Folder of the corpus"),
        ("generate a --limt 3", '--limt: there is no such option, did you mean "--limit"?; allowed: --out, --limit, '),
        ("size a --blin", '--blin: there is no such option, did you mean "--blind"?; allowed: --estimator, '),
        ("generate a --out b --limit abc", '--limit = "abc"; allowed: a whole number'),
        ("generate a --out b --limit=1.5", '--limit = "1.5"; allowed: a whole number'),
        ("generate a --out b --limit", "--limit: the value of this option is missing; allowed: a whole number"),
        ("check a --remake -1", '--remake = "-1"; allowed: a whole number from 0'),
        ("classify --train a --test b --reject 7", '--reject = "7"; allowed: a number from 0 to 1'),
        ("classify --train a --test b --bandwidth q", '--bandwidth = "q"; allowed: a number'),
        ("size a --blind=3", "--blind: this option takes no value; allowed: --blind"),
        ("generate a b --out c", "generate: got unexpected extra argument(s) (b); allowed: "),
    ],
)
def test_a_command_line_that_cannot_be_read_is_told_in_one_line_with_what_is_allowed(line: str, message: str) -> None:
    code, shown, said = run(*line.split())
    assert code == 2
    assert shown == ""
    assert said.startswith(f"error: {message}")
    assert said.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        (("generate", "RECIPE", "--out", ""), "--out"),
        (("generate", "RECIPE", "--out="), "--out"),
        (("generate", "", "--out", "corpus"), "an argument"),
        (("check", ""), "an argument"),
        (("classify", "--train", "impulse-trains", "--test", ""), "--test"),
        (("report", "RECIPE", "--json", "", "--out", "card"), "--json"),
    ],
)
def test_an_empty_value_is_refused_and_does_not_mean_the_current_folder(
    arguments: tuple[str, ...], field: str, tiny_recipe: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    code, _, message = run(*(str(tiny_recipe) if argument == "RECIPE" else argument for argument in arguments))
    assert code == 2
    assert message == f'error: {field} = ""; allowed: a value that is not empty\n'
    assert list(tmp_path.iterdir()) == []


def test_an_argument_that_ends_in_an_equals_sign_is_not_empty(
    tiny_corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "q=").symlink_to(tiny_corpus)
    assert run("info", "q=").exit_code == 0
    assert "--known-size" in run("size", "q=", "--known-size", "3=").stderr


@pytest.mark.parametrize("sign", ["-", "--"])
def test_signs_alone_are_no_command(sign: str) -> None:
    code, _, message = run(sign)
    assert code == 2
    assert message.startswith("error: ")
    assert "Traceback" not in message


LEARNED = "a file that --save wrote, transfer-rows, impulse-trains or impulse-trains-without-INGREDIENT"


@pytest.mark.parametrize(
    ("line", "message"),
    [
        (
            "classify --train nowhere --test nowhere",
            f'--train = "nowhere": no such file or folder; allowed: the folder of a simulated corpus, {LEARNED}',
        ),
        (
            "classify --train impulse-trains --test nowhere",
            '--test = "nowhere": no such file or folder; allowed: the folder of a corpus, simulated or imported',
        ),
        (
            "classify --train impulse-trains --test .",
            '--test = ".": this folder has no manifest.json, so it is not a corpus',
        ),
        ("size nowhere", "nowhere: no such folder; allowed: the folder of a corpus"),
        ("info nowhere", "nowhere: no such folder; allowed: the folder of a corpus"),
        ("preview nowhere --out a.png", "nowhere: no such file or folder, and no dataset of that name (corpus, "),
    ],
)
def test_what_is_not_there_is_told_with_what_may_be_given(
    line: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    code, shown, said = run(*line.split())
    assert (code, shown) == (2, "")
    assert said.startswith(f"error: {message}")
    assert said.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_the_version_is_told() -> None:
    code, shown, _ = run("--version")
    assert code == 0
    assert shown == f"spallgen {program_versions()['spallgen']}\n"


def test_without_a_command_the_help_is_shown() -> None:
    _, shown, message = run()
    assert "Commands:" in shown + message
    assert "error" not in shown + message


def test_a_misspelt_setting_of_a_recipe_is_named_with_the_nearest_known(tiny_recipe: Path, tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(tiny_recipe.read_text().replace("duration_s", "duratoin_s"))
    code, _, message = run("generate", wrong, "--out", tmp_path / "out")
    assert code == 2
    assert "duratoin_s" in message
    assert '"duration_s"' in message
    assert not (tmp_path / "out").exists()


def test_results_that_cannot_be_written_are_bad_input(tiny_corpus: Path, tmp_path: Path) -> None:
    code, _, message = run("info", tiny_corpus, "--json", tmp_path / "no" / "such.json")
    assert code == 2
    assert "--json" in message


def test_a_path_may_begin_with_the_sign_for_ones_home_behind_an_equals_sign_too(
    tiny_corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / "corpus").symlink_to(tiny_corpus)
    assert run("features", "~/corpus", "--out=~/f.csv", "--json=~/f.json").exit_code == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["corpus", "f.csv", "f.json", "here"]
    assert list((tmp_path / "here").iterdir()) == []


def test_results_do_not_replace_what_another_option_or_argument_names(tiny_recipe: Path, tmp_path: Path) -> None:
    link = tmp_path / "link.json"
    link.symlink_to(tiny_recipe)
    before = tiny_recipe.read_text()
    for given in (tiny_recipe, link):
        for command in (("check", tiny_recipe), ("chart", tiny_recipe, "--quick", "--out", tmp_path / "charts")):
            code, _, message = run(*command, "--json", given)
            assert code == 2
            assert f'--json = "{given}": the results would replace what another option or argument names' in message
    assert tiny_recipe.read_text() == before
    assert run("schema", "--out", tmp_path / "s.json", "--json", tmp_path / "s.json").exit_code == 2
    assert not (tmp_path / "s.json").exists()
    assert run("schema", "--out", os.devnull, "--json", os.devnull).exit_code == 0


def test_results_replace_earlier_ones_and_no_file_of_another_kind(tmp_path: Path) -> None:
    recorded, results = tmp_path / "acc_00001.csv", tmp_path / "results.txt"
    recorded.write_text("0.1,0.2\n")
    results.write_text("")
    code, _, message = run("catalog", "--json", recorded)
    assert code == 2
    assert f'--json = "{recorded}": this file holds something else than JSON, which would be lost' in message
    assert recorded.read_text() == "0.1,0.2\n"
    for text in ('[project]\nname = "mine"\n', '{"half": 1', "3\n"):
        recorded.write_text(text)
        assert run("catalog", "--json", recorded).exit_code == 2
        assert recorded.read_text() == text
    for _ in range(2):  # first of an empty file
        assert run("catalog", "--json", results).exit_code == 0
        assert json.loads(results.read_text())


def test_json_of_results_has_null_where_a_number_is_not_finite() -> None:
    assert json.loads(plain_json({"a": (1, float("nan")), 2: {"b": float("inf")}})) == {
        "a": [1, None],
        "2": {"b": None},
    }


@pytest.mark.usefixtures("record_3_fails")
def test_generate_ends_with_1_and_names_the_record_that_could_not_be_made(tiny_recipe: Path, tmp_path: Path) -> None:
    code, shown, message = run("generate", tiny_recipe, "--out", tmp_path / "out", "--limit", 4, "--workers", 1)
    assert code == 1
    assert "3 of 4 records are in" in shown
    assert "record 3 could not be made: " in message
    assert "the response stopped being finite" in message


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no /dev/full")
def test_an_output_that_cannot_be_written_is_told_in_a_line() -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "datagen", "catalog"], cwd=ROOT, stdout=full, stderr=subprocess.PIPE, text=True
        )
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert "the output: No space left on device" in done.stderr


@pytest.mark.parametrize(
    ("arguments", "stream"),
    [
        ("--version", "stdout"),
        pytest.param("catalog --help", "stdout", marks=pytest.mark.slow),
        pytest.param("catalog", "stdout", marks=pytest.mark.slow),
        ("check CORPUS --remake 0", "stdout"),
        ("info nowhere", "stderr"),
        ("frobnicate", "stderr"),
    ],
)
def test_where_nobody_reads_the_output_a_command_ends_quietly(arguments: str, stream: str, tiny_corpus: Path) -> None:
    words = [sys.executable, "-m", "datagen", *arguments.replace("CORPUS", str(tiny_corpus)).split()]
    read, written = os.pipe()
    os.close(read)
    try:
        streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, stream: written}
        done = subprocess.run(words, cwd=ROOT, env=BUFFERED, **streams)
    finally:
        os.close(written)
    assert (done.returncode, done.stdout or b"", done.stderr or b"") == (141, b"", b"")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no /dev/full")
def test_an_output_that_cannot_be_written_is_told_in_a_line_however_short_it_is(tiny_corpus: Path) -> None:
    with Path("/dev/full").open("w") as full:
        words = [sys.executable, "-m", "datagen", "check", str(tiny_corpus), "--remake", "0"]
        done = subprocess.run(words, cwd=ROOT, env=BUFFERED, stdout=full, stderr=subprocess.PIPE, text=True)
    assert (done.returncode, done.stderr) == (2, "error: the output: No space left on device\n")


def test_a_closed_output_ends_no_command() -> None:
    done = subprocess.run(
        ["sh", "-c", '"$0" -m datagen catalog >&-', sys.executable], cwd=ROOT, capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.slow
def test_nor_do_workers_end_where_all_standard_streams_are_closed(tiny_recipe: Path, tmp_path: Path) -> None:
    given = '"$0" -m datagen generate "$1" --out "$2" --records 0,9 --workers 2 <&- >&- 2>&-'
    done = subprocess.run(["sh", "-c", given, sys.executable, tiny_recipe, tmp_path / "out"], cwd=ROOT)
    assert done.returncode == 0
    assert list(read_index(tmp_path / "out")["record"]) == [0, 9]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no /dev/full")
@pytest.mark.parametrize("option", ["--help", "--version"])
def test_help_that_cannot_be_written_is_told_in_one_line(option: str) -> None:
    command = ["sh", "-c", '"$0" -m datagen "$1" >/dev/full', sys.executable, option]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (2, "error: the output: No space left on device\n")

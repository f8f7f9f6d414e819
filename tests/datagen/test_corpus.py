from __future__ import annotations

import pickle
import re
import subprocess
import sys
import tracemalloc
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np
import pytest
import xarray

from datagen.cards.corpus_report import write_report
from datagen.corpus import Corpus
from datagen.errors import BadInput
from datagen.inspection.check import check_corpus
from datagen.inspection.info import corpus_info
from datagen.recipes.recipe import Recipe
from datagen.recordings.importing import import_recordings
from datagen.recordings.spec import load_spec
from datagen.runs.generate import generate
from datagen.runs.workers import Engine
from datagen.scenarios.scenario_text import scenario_of

ROOT = Path(__file__).parents[2]


@pytest.fixture
def corpus(tiny_corpus: Path) -> Corpus:
    return Corpus(tiny_corpus)


def test_a_corpus_is_read_without_the_packages_that_only_its_making_needs(tiny_corpus: Path) -> None:
    reading = (
        "import sys; from datagen.corpus import Corpus\n"
        f"corpus = Corpus({str(tiny_corpus)!r}); corpus.labels; corpus.waveform(0)\n"
        "print([name for name in ('pydantic', 'scipy', 'numba') if name in sys.modules])\n"
    )
    done = subprocess.run([sys.executable, "-c", reading], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_labels_are_read_without_opening_a_shard(tiny_corpus: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(netCDF4, "Dataset", None)
    monkeypatch.setattr(xarray, "open_dataset", None)
    labels = Corpus(tiny_corpus).labels
    assert len(labels) == 14
    assert set(labels["rig"]) == {"gearbox", "fan"}


def test_a_place_that_is_no_whole_number_is_none(corpus: Corpus) -> None:
    assert np.array_equal(corpus[np.int64(3)][0], corpus[3][0])
    for place in (slice(0, 3), 1.5, "x"):
        with pytest.raises(TypeError, match="cannot be interpreted as an integer"):
            corpus[place]  # type: ignore[index]


@pytest.mark.slow
def test_folders_may_be_given_as_text(tiny_corpus: Path, tmp_path: Path) -> None:
    assert repr(Corpus(str(tiny_corpus))) == f"Corpus('{tiny_corpus}')"
    assert corpus_info(str(tiny_corpus)).records == check_corpus(str(tiny_corpus)).records == 14
    assert write_report(str(tiny_corpus), str(tmp_path / "report")).folder == str(tmp_path / "report")
    np.save(tmp_path / "a.npy", np.random.default_rng(0).standard_normal(400))
    settings = 'name = "r"\nfiles = "a.npy"\nunit = "g"\nrate_hz = 1000\ny = "data"\n'
    (tmp_path / "spec.toml").write_text(f'name = "s"\n[[recording]]\n{settings}')
    spec = load_spec(str(tmp_path / "spec.toml"))
    assert import_recordings(spec, str(tmp_path / "out"), str(tmp_path)).records == 1


def test_a_waveform_is_what_plain_xarray_reads(corpus: Corpus) -> None:
    for path in sorted((corpus.folder / "shards").glob("*.nc")):
        with xarray.open_dataset(path) as shard:
            for position, record in enumerate(shard["record"].values):
                assert np.array_equal(corpus.waveform(record), shard["acceleration"].values[position])
                assert np.array_equal(corpus.waveform(record, "stiffness"), shard["stiffness"].values[position])


OPENED_TWICE = """
import sys
from pathlib import Path
import xarray

paths = sorted(Path(sys.argv[1]).glob("shards/*.nc"))
kept = [xarray.open_dataset(path) for path in paths]
again = [xarray.open_dataset(path) for path in paths]
for shard in again:
    shard.close()
with xarray.open_dataset(paths[0]) as shard:
    print(shard.load().sizes["record"])
"""


def test_a_shard_may_be_opened_twice_and_read_once_one_of_both_is_closed(tiny_corpus: Path) -> None:
    """Where texts of any length were stored, HDF5 2.2.0 ended the process."""
    done = subprocess.run(
        [sys.executable, "-c", OPENED_TWICE, tiny_corpus], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert int(done.stdout) > 0


def test_the_dataset_of_a_record_holds_its_own_passes_and_defects_only(corpus: Corpus) -> None:
    total = 0
    for record in corpus.labels["record"]:
        found = corpus.dataset(record)
        assert set(found["pass_record"].values) <= {record}
        assert found.sizes["defect"] == found["spalls"]
        total += found.sizes["ball_pass"]
    stored = 0
    for path in (corpus.folder / "shards").glob("*.nc"):
        with xarray.open_dataset(path) as shard:
            stored += shard.sizes["ball_pass"]
    assert total == stored > 0


def test_the_scenario_of_a_record_reads_back(corpus: Corpus) -> None:
    assert corpus.scenario(3)["record"] == 3
    assert scenario_of(str(corpus.waveform(3, "scenario"))).record == 3


def test_contact_force_is_stored_of_the_first_record_of_each_rig_and_condition(corpus: Corpus) -> None:
    firsts = corpus.labels.groupby(["rig", "condition"])["record"].min()
    kept = [record for record in corpus.labels["record"] if "contact_force" in corpus.dataset(record)]
    assert kept == sorted(firsts)
    for record in kept:
        assert np.isfinite(corpus.waveform(record, "contact_force")).all()


def test_batches_cover_every_record_once_in_order(corpus: Corpus) -> None:
    gearbox = corpus.labels.query("rig == 'gearbox'")["record"]
    batches = list(corpus.batches(3, records=gearbox))
    assert [len(records) for records, _ in batches] == [3, 3, 2]
    assert list(np.concatenate([records for records, _ in batches])) == list(gearbox)
    assert np.array_equal(np.concatenate([signals for _, signals in batches]), corpus.to_numpy(records=gearbox))


def test_records_of_different_shapes_are_not_stacked(corpus: Corpus) -> None:
    firsts = corpus.labels.query("condition == 'line'").groupby("rig")["record"].min()
    with pytest.raises(BadInput, match=r"differ in shape \(\d+: \(.*, 14\), \d+: \(.*, 12\)\)"):
        corpus.to_numpy("contact_force", firsts)


def test_stacked_labels_are_those_of_the_table(corpus: Corpus) -> None:
    assert list(corpus.to_numpy("condition")) == list(corpus.labels["condition"])
    assert list(corpus.to_numpy("balls")) == list(corpus.labels["balls"])


def test_records_are_stacked_without_a_copy_of_all(corpus: Corpus) -> None:
    gearbox = list(corpus.labels.query("rig == 'gearbox'")["record"])
    corpus.to_numpy(records=gearbox)  # opens the shards
    tracemalloc.start()
    stacked = corpus.to_numpy(records=gearbox * 30)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 1.3 * stacked.nbytes


def test_an_unknown_record_or_signal_is_refused_with_what_is_known(corpus: Corpus) -> None:
    for nothing in (float("nan"), float("inf"), "three", None, 1.5, True):
        with pytest.raises(BadInput, match="not the index of a record"):
            corpus.waveform(nothing)
    with pytest.raises(BadInput, match="record = 14: not in this corpus"):
        corpus.waveform(14)
    with pytest.raises(BadInput, match=r"velocity.*allowed: .*acceleration"):
        corpus.waveform(0, "velocity")
    with pytest.raises(BadInput, match=r"no such signal; dataset\(0\) has it"):
        corpus.waveform(0, "entry_time")


def test_a_corpus_is_a_sequence_of_signals_and_labels_that_can_be_pickled(corpus: Corpus) -> None:
    corpus.waveform(0)
    again = pickle.loads(pickle.dumps(corpus))
    assert len(again) == 14
    signal, labels = again[3]
    assert np.array_equal(signal, corpus.waveform(3))
    assert labels["record"] == 3


def test_few_files_stay_open_however_many_are_read(tiny_corpus: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("datagen.corpus_files.open_shards.OPEN_FILES", 2)
    corpus = Corpus(tiny_corpus)
    for record in range(14):
        corpus.signal(record)
        assert len(corpus.open_files) in (1, 2)
    corpus.close()
    assert not corpus.open_files


def test_a_corpus_dropped_without_closing_does_no_harm(tiny_corpus: Path) -> None:
    for _ in range(20):  # netCDF4 crashed here when its files were left to the garbage collector
        first = Corpus(tiny_corpus).signal(0)
    assert np.isfinite(first).all()


def test_a_forked_process_opens_its_own_files(corpus: Corpus) -> None:
    script = (
        "import multiprocessing; from datagen.corpus import Corpus\n"
        f"corpus = Corpus({str(corpus.folder)!r}); before = corpus.signal(5)\n"
        "with multiprocessing.get_context('fork').Pool(2) as pool:\n"
        "    read = pool.map(corpus.signal, [5] * 8)\n"
        "print(all((one == before).all() for one in [*read, corpus.signal(5)]))\n"
    )
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.stdout == "True\n", done.stderr


def test_folds_keep_the_records_of_a_bearing_together_and_use_each_record_once(corpus: Corpus) -> None:
    bearing = corpus.labels.set_index("record")["bearing_id"]
    tested = []
    for train, test in corpus.folds(3):
        assert not set(bearing[train]) & set(bearing[test])
        assert sorted([*train, *test]) == list(range(14))
        tested += list(test)
    assert sorted(tested) == list(range(14))


@pytest.mark.filterwarnings("error")
def test_folds_warn_of_nothing_that_was_not_asked_for(corpus: Corpus) -> None:
    alone = Corpus(corpus.folder)
    alone.labels["spalls"] = [1] + [0] * 13
    assert len(list(alone.folds(3, "spalls"))) == 3


def test_folds_follow_from_their_seed(corpus: Corpus) -> None:
    zero, again, one = ([test.tolist() for _, test in corpus.folds(3, seed=seed)] for seed in (0, 0, 1))
    assert zero == again
    assert zero != one


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            (50, "rate_hz"),
            "count = 50: its records are of 10 bearings, and each fold tests its own; allowed: a whole number from 2",
        ),
        ((9, "rig"), "and of no rig are there more than 8 records; allowed: a whole number from 2 to 8"),
        ((1, "rate_hz"), "allowed: a whole number from 2 to 10"),
        ((2.5,), "count = 2.5: "),
        ((3, "speed"), 'stratify = "speed": no such label; allowed: '),
        ((3, "bpfo"), 'stratify = "bpfo": this label takes other values with every record; allowed: '),
        ((3, "rig", -1), "seed = -1; allowed: a whole number from 0 to 4294967295"),
        ((3, "rig", 0.5), "seed = 0.5; "),
        ((7, "record"), "and of no record are there more than 1 records; allowed: none"),
    ],
)
def test_folds_that_cannot_be_are_refused_with_what_can(options: tuple[Any, ...], message: str, corpus: Corpus) -> None:
    with pytest.raises(BadInput) as caught:
        corpus.folds(*options)
    assert message in str(caught.value)


def test_records_of_unknown_bearings_cannot_be_parted_and_the_message_says_why(corpus: Corpus) -> None:
    unknown = Corpus(corpus.folder)
    unknown.labels["bearing_id"] = "unknown"
    with pytest.raises(BadInput, match="the bearing_id of its records is unknown, so that they count as one bearing"):
        unknown.folds(3, "rate_hz")


@pytest.mark.parametrize("values", [[1.0, np.nan] * 7, [np.nan] * 14, np.array([True, np.nan] * 7, dtype=object)])
def test_folds_may_be_alike_in_a_label_that_is_unknown_of_some_records_or_all(values: Any, corpus: Corpus) -> None:
    partly_known = Corpus(corpus.folder)
    partly_known.labels["spalls"] = values
    assert sorted(record for _, test in partly_known.folds(3, "spalls") for record in test) == list(range(14))


def test_as_many_folds_as_bearings_leave_one_out(corpus: Corpus) -> None:
    assert len(list(corpus.folds(corpus.labels["bearing_id"].nunique(), "rate_hz"))) == 10


def test_info_counts_every_record_and_gives_the_ranges_of_the_labels(corpus: Corpus) -> None:
    info = corpus_info(corpus.folder)
    assert info.records == info.asked == info.recipe_records == 14
    assert info.counts["rig"] == {"gearbox": 8, "fan": 6}
    assert sum(info.counts["condition"].values()) == 14
    assert (info.ranges["speed_rpm"].smallest, info.ranges["speed_rpm"].largest) == pytest.approx(
        (420.0, 800.0), rel=1e-12
    )  # rounding
    assert info.ranges["snr_db"].missing == 6
    assert info.bytes == sum(path.stat().st_size for path in (corpus.folder / "shards").glob("*.nc"))


def test_a_folder_that_is_no_corpus_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="not a corpus"):
        Corpus(tmp_path)
    (tmp_path / "manifest.json").write_text('{"name": 3')
    with pytest.raises(BadInput, match="not a manifest"):
        Corpus(tmp_path)


def imported_corpus(folder: Path) -> Corpus:
    """A corpus of two recordings of other lengths, so two shards, without tables of ball passes and defects."""
    for name, size in (("a", 400), ("b", 500)):
        np.save(folder / f"{name}.npy", np.random.default_rng(size).standard_normal(size))
    settings = 'files = "*.npy"\nunit = "g"\nrate_hz = 1000\ny = "data"\n'
    (folder / "spec.toml").write_text(f'name = "mine"\n[[recording]]\nname = "all"\n{settings}')
    import_recordings(load_spec(folder / "spec.toml"), folder / "imported")
    return Corpus(folder / "imported")


@pytest.mark.parametrize("kind", ["simulated", "imported"])
def test_all_shards_open_as_one_lazy_dataset_as_the_readme_says(
    kind: str, tiny_corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    corpus, record = (Corpus(tiny_corpus), 3) if kind == "simulated" else (imported_corpus(tmp_path), 1)
    assert len(list((corpus.folder / "shards").glob("*.nc"))) > 1
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    code = next(block for block in re.findall(r"```python\n(.*?)```", readme, re.DOTALL) if "open_mfdataset" in block)
    (tmp_path / "quickstart-corpus").symlink_to(corpus.folder.absolute(), target_is_directory=True)
    monkeypatch.chdir(tmp_path)
    names = {"xarray": xarray}
    exec(code, names)
    with names["whole"] as whole:
        assert sorted(whole["record"].values) == list(range(len(corpus)))
        assert not {"ball", "ball_pass", "defect"} & set(whole.dims)  # as long as each shard has it
        opened = whole["acceleration"].sel(record=record).dropna("time").values
    assert np.array_equal(opened, corpus.waveform(record))


def test_one_record_and_the_tables_of_a_shard_are_read_as_the_readme_says(
    tiny_corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    (tmp_path / "quickstart-corpus").symlink_to(tiny_corpus.absolute(), target_is_directory=True)
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    for word in ("xarray.open_dataset", "Corpus(", "ball_pass"):
        exec(next(block for block in blocks if word in block and "open_mfdataset" not in block), names)
    with names["shard"] as shard, names["corpus"] as corpus:
        assert np.array_equal(names["acceleration"], corpus.waveform(names["its_labels"]["record"]))
        assert np.array_equal(names["one_axis"], corpus.waveform(3)[:, 1])
        assert len(names["passes"]) == shard.sizes["ball_pass"] > 0
        assert set(names["spalls"]) == {name for name in shard.variables if name.startswith("defect_")}
        assert set(names["heard"].pass_record) <= {0}


@pytest.mark.parametrize("variable", ["entry_time", "pass_record", "time", "axis"])
def test_what_is_not_one_a_record_is_no_signal_of_a_record(corpus: Corpus, variable: str) -> None:
    with pytest.raises(BadInput, match=f"{variable}.*allowed: .*acceleration"):
        corpus.waveform(5, variable)


@pytest.mark.parametrize("chosen", [[True, False], np.array([True, False]), [2.9], ["2"]])
def test_masks_and_fractions_are_no_record_indices(corpus: Corpus, chosen: object) -> None:
    with pytest.raises((BadInput, ValueError)):
        corpus.to_numpy("acceleration", chosen)
    with pytest.raises((BadInput, ValueError)):
        list(corpus.batches(2, records=chosen))
    assert corpus.to_numpy("acceleration", [np.int32(2), 2.0]).shape[0] == 2


def test_no_records_and_no_size_of_batches_are_refused(corpus: Corpus) -> None:
    with pytest.raises(BadInput, match="no record was chosen"):
        corpus.to_numpy("acceleration", [])
    with pytest.raises(BadInput, match="size = 0; allowed: a whole number from 1 on"):
        corpus.batches(0)  # at once, and not only where the first batch is taken
    with pytest.raises(BadInput, match=r"size = 2\.5; allowed: a whole number from 1 on"):
        corpus.batches(2.5)  # type: ignore[arg-type]


def test_a_folder_may_be_named_by_the_sign_for_ones_home(corpus: Corpus, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(corpus.folder.parent))
    with Corpus(f"~/{corpus.folder.name}") as same:
        assert len(same) == len(corpus)
    with pytest.raises(BadInput, match="no such folder"):
        Corpus("~nobody-of-this-name/corpus")


def test_everything_of_a_record_is_its_own_and_may_be_closed_and_pickled(corpus: Corpus) -> None:
    with corpus.dataset(3) as dataset:
        text = dataset["scenario"].item()
    assert corpus.waveform(3, "scenario") == text
    assert pickle.loads(pickle.dumps(corpus.dataset(3))).identical(corpus.dataset(3))


def test_a_corpus_is_where_it_was_opened_wherever_its_user_goes(
    tiny_corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tiny_corpus.parent)
    corpus = Corpus(tiny_corpus.name)
    monkeypatch.chdir(tmp_path)
    signal = corpus.waveform(2)
    assert np.array_equal(pickle.loads(pickle.dumps(corpus)).waveform(2), signal)
    assert np.array_equal(Corpus(tiny_corpus).waveform(2), signal)


def test_a_record_that_a_later_run_has_moved_is_not_taken_for_another(tiny: Recipe, tmp_path: Path) -> None:
    alone = Engine(workers=1)
    generate(tiny, tmp_path / "out", records=[5], engine=alone)
    corpus = Corpus(tmp_path / "out")
    before = corpus.waveform(5)
    generate(tiny, tmp_path / "out", records=[4], engine=alone)
    for read in (corpus.waveform, corpus.signal, corpus.dataset, corpus.scenario):
        with pytest.raises(BadInput, match="open it again"):
            read(5)
    assert np.array_equal(Corpus(tmp_path / "out").waveform(5), before)


@pytest.mark.slow
def test_a_folder_may_be_named_from_home(tiny_corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tiny_corpus.parent))
    folder = f"~/{tiny_corpus.name}"
    assert len(Corpus(folder)) == corpus_info(folder).records == 14
    assert check_corpus(folder).sound
    monkeypatch.setenv("HOME", str(tmp_path))
    write_report(tiny_corpus, "~/card")
    assert (tmp_path / "card" / "card.md").is_file()

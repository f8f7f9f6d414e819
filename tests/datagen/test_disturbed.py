"""The script that disturbs recordings: what it refuses, and how strong what it adds is."""

import numpy as np
import pytest
import xarray
from scipy.signal import find_peaks

from datagen.errors import BadInput


@pytest.fixture
def script(load_script):
    return load_script("make_disturbed")


def test_recordings_with_a_shaft_angle_are_refused_before_anything_is_learned(
    script, tiny_corpus, copy, tmp_path, monkeypatch
):
    script.require_no_angle(tiny_corpus)
    second = sorted((copy / "shards").glob("*.nc"))[1]
    shard = xarray.load_dataset(second)
    second.unlink()
    shard.assign(shaft_angle=shard["acceleration"].isel(axis=0, drop=True)).to_netcdf(second)
    monkeypatch.setattr(script, "training_records", None)
    with pytest.raises(BadInput, match=r"record 2 has a shaft angle.*without a shaft angle"):
        script.main(tmp_path / "train", [copy])


def test_knocks_are_as_strong_as_the_record_and_come_as_often_as_asked(script):
    generator, rate = np.random.default_rng(1), 10_000.0
    record = generator.normal(scale=3.0, size=(20_000, 2))
    disturbed = script.knocking(record, rate, generator, 20.0)
    knocks = disturbed.signal - record
    assert disturbed[1:] == (rate, 1.0, False)
    assert knocks.std(axis=0) == pytest.approx(record.std(axis=0))
    at, _ = find_peaks(np.abs(knocks[:, 0]), height=0.4 * np.abs(knocks[:, 0]).max(), distance=int(0.03 * rate))
    assert at.size == pytest.approx(40, abs=1)
    assert np.diff(at) / rate == pytest.approx(0.05, rel=0.1)

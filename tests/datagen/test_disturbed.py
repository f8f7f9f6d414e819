"""The script that disturbs recordings refuses what it would read otherwise than `classify`."""

from pathlib import Path

import pytest
import xarray

from datagen.errors import BadInput


@pytest.fixture
def script(load_script, monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parents[2] / "docs"))
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

"""HDF5 files that neither MATLAB nor netCDF wrote: under either ending, with numbers in their attributes."""

from __future__ import annotations

import json
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray
from imports import Bring

from datagen.errors import BadInput
from datagen.formats.csv_layout import CsvLayout
from datagen.formats.reading import read_arrays

SAMPLES = np.random.default_rng(8).standard_normal((300, 2)).astype(np.float32)
SPEC = """
[[recording]]
name = "all"
files = "a.*"
unit = "m/s2"
rate_hz = {variable = "@fs"}
speed_rpm = {variable = "run@rpm"}
load_n = {variable = "run.vib@load", factor = 1000.0}
y = "run.v*[:,1]"
"""


def write(path: Path) -> None:
    with h5py.File(path, "w") as file:
        file.attrs["fs"] = np.array([2000])
        file.attrs["made by"] = "somebody"
        group = file.create_group("run")
        group.attrs["rpm"] = 1480.5
        group.create_dataset("vib", data=SAMPLES).attrs["load"] = 0.25


@pytest.mark.parametrize("ending", ["h5", "hdf5", "mat"])
def test_samples_come_in_column_by_column_with_the_numbers_of_attributes(
    ending: str, bring: Bring, tmp_path: Path
) -> None:
    write(tmp_path / f"a.{ending}")
    corpus = bring(SPEC)
    assert corpus.waveform(0, "acceleration")[:, 0].tolist() == SAMPLES[:, 1].tolist()
    assert corpus.labels.loc[0, ["rate_hz", "speed_rpm", "load_n"]].tolist() == [2000.0, 1480.5, 250.0]
    assert json.loads(corpus.waveform(0, "provenance"))["variables"]["speed_rpm"] == "run@rpm"


def test_attributes_of_a_netcdf_file_are_found_by_the_names_of_their_variables(tmp_path: Path) -> None:
    data = xarray.DataArray(SAMPLES[:, 0], dims="sample", attrs={"rpm": 900, "unit": "g"})
    xarray.Dataset({"acc": data}, attrs={"fs": 1000.0}).to_netcdf(tmp_path / "a.nc")
    arrays = read_arrays(tmp_path / "a.nc", None, CsvLayout())
    assert (arrays["acc@rpm"], arrays["@fs"]) == (900, 1000.0)
    assert list(arrays) == ["acc"]


@pytest.mark.parametrize("name", ["@none", "@made by", "run@fs", "none@fs", "@f*"])
def test_an_attribute_that_is_absent_or_a_text_is_refused_with_the_names_of_variables(
    name: str, bring: Bring, tmp_path: Path
) -> None:
    write(tmp_path / "a.h5")
    with pytest.raises(BadInput) as refused:
        bring(SPEC.replace('"@fs"', f'"{name}"'))
    place, field = tmp_path / "a.h5", f'rate_hz = "{name}"'
    assert str(refused.value) == f"{place}: {field}: the file has no such variable; allowed: run.vib"

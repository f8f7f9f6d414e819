"""A part that is taken of a recording, against a file that holds nothing but that part."""

from __future__ import annotations

import numpy as np
from imports import Bring

RATE = 12000
FIRST, LAST = 3480, 6960  # 0.29 and 0.58 s, which times the rate are a rounding below
SPEC = '[[recording]]\nname = "all"\nfiles = "{file}.npz"\nunit = "g"\nrate_hz = 12000\nspeed_rpm = 1800\ny = "y"\n'


def ringing(frequency: float, size: int, seed: int) -> np.ndarray:
    """Noise with a knock every 400 samples that rings at this frequency, Hz."""
    time = np.arange(400) / RATE
    knock = np.exp(-600.0 * time) * np.sin(2.0 * np.pi * frequency * time)
    return np.resize(5.0 * knock, size) + 0.1 * np.random.default_rng(seed).standard_normal(size)


def test_a_part_comes_in_as_a_file_that_holds_it_alone(bring: Bring, tmp_path) -> None:
    y = np.concatenate([ringing(1500, FIRST, 1), ringing(4200, LAST - FIRST, 2), ringing(1500, FIRST, 3)])
    x = ringing(1500, y.size, 4)
    np.savez(tmp_path / "whole.npz", x=x, y=y)
    np.savez(tmp_path / "part.npz", x=x[FIRST:LAST], y=y[FIRST:LAST])
    taken = bring(SPEC.format(file="whole") + 'x = "x"\nfrom_s = 0.29\nto_s = 0.58\n', "taken")
    alone, along_y = (bring(SPEC.format(file="part") + more, f"alone{more[:1]}") for more in ('x = "x"\n', ""))
    assert np.array_equal(taken.waveform(0), alone.waveform(0))
    band = ["envelope_band_low", "envelope_band_high"]
    low, high = along_y.labels.loc[0, band]
    assert low < 4200 < high
    for corpus in (taken, alone):
        assert corpus.labels.loc[0, band].tolist() == [low, high]
        assert np.array_equal(corpus.waveform(0, "envelope"), along_y.waveform(0, "envelope"))

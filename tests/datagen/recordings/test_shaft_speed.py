from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from imports import Bring, Mat

from datagen.corpus import Corpus
from datagen.errors import BadInput
from datagen.inspection.check import check_corpus
from datagen.recordings.doubts import STANDING
from datagen.recordings.importing import import_recordings
from datagen.recordings.pulses import rising_edges
from datagen.recordings.settings import Tach
from datagen.recordings.shaft_speed import is_steady, shaft_angle, tach_speed
from datagen.recordings.source import Source
from datagen.recordings.spec import load_spec


def test_a_pulse_at_the_end_of_a_piece_belongs_to_the_next() -> None:
    pulses = np.zeros(1000)
    pulses[[100, 200, 300, 450, 500, 550]] = 1.0
    source = Source(SimpleNamespace(path="made-up"), {})  # type: ignore[arg-type]
    tach = Tach(variable="tacho", threshold=1.0)  # edges on the very samples
    times = rising_edges(pulses, 1.0) / 1000.0
    assert tach_speed(source, tach, times, 0.0, 0.45) == pytest.approx(600.0)
    assert tach_speed(source, tach, times, 0.45, 1.0) == pytest.approx(1200.0)


def test_three_pulses_are_the_fewest_that_give_a_speed() -> None:
    source = Source(SimpleNamespace(path="made-up"), {})  # type: ignore[arg-type]
    tach, times = Tach(variable="tacho"), np.array([0.1, 0.2, 0.3])
    assert tach_speed(source, tach, times, 0.0, 1.0) == pytest.approx(600.0)
    with pytest.raises(BadInput, match="2 pulses from 0 to 1 s; allowed: at least 3 pulses"):
        tach_speed(source, tach, times[:2], 0.0, 1.0)


def test_times_of_pulses_in_another_unit_than_s_come_with_the_factor_that_makes_s_of_them() -> None:
    source = Source(SimpleNamespace(path="made-up"), {})  # type: ignore[arg-type]
    tach, times = Tach(variable="tacho", times=True), np.array([0.3, 40_541.0, 81_081.0])
    with pytest.raises(BadInput, match=r"1 pulse from 0 to 4 s; .*in s: tach\.factor = 1e-3 for ms, 1e-6"):
        tach_speed(source, tach, times, 0.0, 4.0)


def test_a_piece_has_the_mean_of_its_own_part_of_a_speed_channel(bring: Bring, mat: Mat) -> None:
    mat("a.mat", rpm=np.concatenate([np.full(33, 600.0), np.full(33, 900.0), np.full(33, 1200.0)]))
    common = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    speed = 'speed_rpm = {variable = "rpm"}\n'
    assert bring(common + speed, "whole").labels["speed_rpm"].tolist() == pytest.approx([900.0])
    cut = bring(common + speed + "cut_s = 0.1333\n", "cut").labels["speed_rpm"]  # 133 of 400 samples
    assert cut.tolist() == pytest.approx([600.0, 900.0, 1200.0], rel=0.02)


def test_a_place_of_a_speed_channel_that_two_pieces_share_counts_in_both(bring: Bring, mat: Mat) -> None:
    mat("a.mat", turns=np.array([10.0, 11.0, 12.0]))
    corpus = bring(
        '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
        'cut_s = 0.1\nspeed_rpm = {variable = "turns", factor = 60}\nload_n = {variable = "turns", factor = 1e3}\n'
    )
    assert corpus.labels["speed_rpm"].tolist() == pytest.approx([600.0, 630.0, 690.0, 720.0])
    assert corpus.labels["load_n"].tolist() == pytest.approx([11e3] * 4)


@pytest.mark.parametrize(
    ("wish", "told"),
    [
        ("rpm", "holds 2 numbers from 600 to 1797 (rpm is 1x2)"),
        ("rpm[0]", "holds 2 numbers from 600 to 1797 (rpm is 1x2)"),
        ("course", "holds 80 numbers from 600 to 1797 (course is 40x2)"),
    ],
)
def test_speeds_of_several_shafts_have_no_mean(wish: str, told: str, bring: Bring, mat: Mat) -> None:
    mat("a.mat", rpm=np.array([[1797.0, 600.0]]), course=np.tile([1797.0, 600.0], (40, 1)))
    spec = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    with pytest.raises(BadInput) as refused:
        bring(spec + f'speed_rpm = {{variable = "{wish}"}}\n')
    assert f'a.mat: speed_rpm = "{wish}": {told}; allowed: a single number of it' in str(refused.value)
    for number, one in enumerate(("rpm[0,1]", "course[:,1]")):
        corpus = bring(spec + f'speed_rpm = {{variable = "{one}"}}\n', f"one{number}")
        assert corpus.labels["speed_rpm"].tolist() == [600.0]


@pytest.mark.parametrize(("last", "mean"), [(1490.0, 1245.0), (1510.0, None)])
def test_a_few_speeds_of_one_shaft_are_no_further_apart_than_a_half(
    last: float, mean: float | None, bring: Bring, mat: Mat
) -> None:
    mat("a.mat", rpm=np.array([1000.0, last]))
    spec = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    spec += 'speed_rpm = {variable = "rpm"}\n'
    if mean is None:
        with pytest.raises(BadInput, match="holds 2 numbers from 1000 to 1510"):
            bring(spec)
    else:
        assert bring(spec).labels["speed_rpm"].tolist() == [mean]


def test_scales_of_several_channels_have_no_mean(bring: Bring, mat: Mat) -> None:
    mat("a.mat", sensitivity=np.array([[10.0, 9.5]]))
    spec = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    with pytest.raises(BadInput, match=r"scale = .*holds 2 numbers from 9\.5 to 10 .*one number, or one of it$"):
        bring(spec + 'scale = {variable = "sensitivity"}\n')
    assert len(bring(spec + 'scale = {variable = "sensitivity[0,1]"}\n')) == 1


CONSTANTS = {
    "rate_hz": [1000.0, 1001.0], "scale": [1.0, 1.1], "bpfo": [3.6, 3.7], "bpfi": [5.4, 5.5], "bsf": [2.3, 2.4],
    "ftf": [0.39, 0.4], "extent_mm": [1.0, 1.1], "extent_deg": [1.0, 1.1], "depth_um": [1.0, 1.1],
}  # fmt: skip


@pytest.mark.parametrize("name", CONSTANTS)
def test_what_is_one_number_for_a_bearing_or_a_sensor_has_no_mean_however_alike(
    name: str, bring: Bring, mat: Mat
) -> None:
    mat("a.mat", held=np.array(CONSTANTS[name]), alike=np.full(2, CONSTANTS[name][0]))
    spec = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\ny = "sig"\nlocation = "outer"\n'
    spec += "" if name == "rate_hz" else "rate_hz = 1000\n"
    with pytest.raises(BadInput, match=rf'{name} = "held": holds 2 numbers from'):
        bring(f'{spec}{name} = {{variable = "held"}}\n')
    assert len(bring(f'{spec}{name} = {{variable = "alike"}}\n')) == 1


@pytest.mark.parametrize(
    ("zeros", "mean"), [(0, 1000.0), (10, 500.0), (11, None), (20, 0.0)], ids=["none", "half", "most", "all"]
)
def test_a_speed_that_is_0_in_most_places_has_no_mean_but_in_all(
    zeros: int, mean: float | None, tmp_path: Path, mat: Mat
) -> None:
    mat("a.mat", rpm=np.repeat([0.0, 1000.0], [zeros, 20 - zeros]))
    (tmp_path / "spec.toml").write_text(
        'name = "mine"\n[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
        'speed_rpm = {variable = "rpm"}\n'
    )
    if mean is None:
        with pytest.raises(BadInput, match="is 0 in 11 of 20 places, so its mean means nothing"):
            import_recordings(load_spec(tmp_path / "spec.toml"), tmp_path / "corpus")
        return
    done = import_recordings(load_spec(tmp_path / "spec.toml"), tmp_path / "corpus")
    with Corpus(tmp_path / "corpus") as corpus:
        assert corpus.labels["speed_rpm"].tolist() == [mean]
        assert corpus.has(0, "shaft_angle") == (zeros == 10)
    # A row of nothing but 0 is that of a shaft that was not measured, or stands throughout: no place is odd.
    assert [doubt for doubt in done.doubts if "speed that is 0" in doubt] == [STANDING] * (zeros == 10)


def test_a_table_of_one_speed_throughout_is_that_speed(bring: Bring, tmp_path: Path) -> None:
    signal = np.random.default_rng(1).standard_normal(400)
    half = np.tile(np.array([1797.0, 1798.0], np.float16), 20)  # whose mean half precision does not hold
    np.savez(tmp_path / "a.npz", sig=signal, table=np.full((2, 2), 1797.0), half=half)
    spec = '[[recording]]\nname = "all"\nfiles = "a.npz"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    for name, rpm in (("table", 1797.0), ("half", 1797.5)):
        assert bring(f'{spec}speed_rpm = {{variable = "{name}"}}\n', name).labels["speed_rpm"].tolist() == [rpm]


def test_a_column_whose_first_place_alone_holds_the_number_has_no_mean(bring: Bring, mat: Mat) -> None:
    mat("a.mat", table=np.array([[1750.0, 400.0]] + [[0.0, 0.0]] * 99))
    spec = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    message = r'a\.mat: speed_rpm = "table\[:,0\]": is 0 in 99 of 100 places, so .*a single number of it, as in "NAME'
    with pytest.raises(BadInput, match=message):
        bring(spec + 'speed_rpm = {variable = "table[:,0]"}\n')
    corpus = bring(spec + 'speed_rpm = {variable = "table[0,0]"}\nload_n = {variable = "table[0,1]"}\n')
    assert corpus.labels[["speed_rpm", "load_n"]].to_numpy().tolist() == [[1750.0, 400.0]]


def test_pulses_of_another_length_need_a_rate_of_their_own(bring: Bring, mat: Mat) -> None:
    mat("a.mat", tacho=np.tile([0.0, 0.0, 0.0, 0.0, 1.0], 20))
    spec = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    message = r'a\.mat: tach\.variable = "tacho": holds 100 samples, the vibration 400; allowed: .* in tach\.rate_hz'
    with pytest.raises(BadInput, match=message):
        bring(spec + 'tach = {variable = "tacho"}\n')
    corpus = bring(spec + 'tach = {variable = "tacho", rate_hz = 250}\n')
    assert corpus.labels["speed_rpm"].tolist() == pytest.approx([3000.0])


@pytest.mark.parametrize(("rate", "lasts"), [(2500, "0.04"), (100, "1"), (225, "0.4444"), (280, "0.3571")])
def test_pulses_must_last_as_long_as_the_vibration(bring: Bring, mat: Mat, rate: int, lasts: str) -> None:
    mat("a.mat", tacho=np.tile([0.0, 0.0, 0.0, 0.0, 1.0], 20))
    spec = '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
    message = (
        rf"a\.mat: tach\.rate_hz = {rate}\.0: its 100 samples then last {lasts} s, the vibration 0\.4 s; allowed: "
    )
    with pytest.raises(BadInput, match=message):
        bring(spec + f'tach = {{variable = "tacho", rate_hz = {rate}}}\n')


def standing(tmp_path: Path, mat: Mat, more: str = "") -> tuple[Corpus, tuple[str, ...]]:
    """A recording of one second each at 0, 10, 20 and 30 turns a second, and of which records a speed of 0 is told."""
    mat("a.mat", np.random.default_rng(1).standard_normal(4000), rpm=np.repeat([0.0, 600.0, 1200.0, 1800.0], 25))
    (tmp_path / "spec.toml").write_text(
        'name = "mine"\n[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\n'
        'speed_rpm = {variable = "rpm"}\n' + more
    )
    summary = import_recordings(load_spec(tmp_path / "spec.toml"), tmp_path / "corpus")
    (told,) = (records for doubt, records in summary.doubts.items() if "speed that is 0" in doubt)
    return Corpus(tmp_path / "corpus"), told


def test_a_speed_of_0_is_that_of_a_shaft_that_stands_and_is_told(tmp_path: Path, mat: Mat) -> None:
    corpus, told = standing(tmp_path, mat)
    assert told == ("a (25 of 100 places)",)
    assert corpus.labels["speed_rpm"].tolist() == pytest.approx([900.0])
    angle = corpus.waveform(0, "shaft_angle")
    assert angle[[0, 1000, 2000, 3000]] / (2.0 * np.pi) == pytest.approx([0.0, 0.0, 10.0, 30.0], abs=1e-4)
    assert check_corpus(corpus.folder).sound


def test_a_speed_of_0_is_told_of_the_pieces_that_have_it(tmp_path: Path, mat: Mat) -> None:
    corpus, told = standing(tmp_path, mat, "cut_s = 2\n")
    assert told == ("a#0 (25 of 50 places)",)
    assert corpus.labels["speed_rpm"].tolist() == pytest.approx([300.0, 1500.0])


@pytest.mark.parametrize(("part", "places"), [("from_s = 0.5", "13 of 88"), ("to_s = 3", "25 of 75")])
def test_a_speed_of_0_is_told_of_the_part_that_is_taken(part: str, places: str, tmp_path: Path, mat: Mat) -> None:
    _, told = standing(tmp_path, mat, f"{part}\n")
    assert told == (f"a ({places} places)",)


TACH = (
    '[[recording]]\nname = "all"\nfiles = "*.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\ntach = {variable = "tacho"}\n'
)
PULSES = np.tile([0.0] * 39 + [1.0], 10)  # one in 40 ms


def test_the_nominal_speed_stands_for_a_tach_that_is_absent_or_without_pulses(bring: Bring, mat: Mat) -> None:
    mat("absent.mat")
    mat("dead.mat", tacho=np.zeros(400))
    mat("pulsing.mat", tacho=PULSES)
    labels = bring(TACH + "nominal_speed_rpm = 1480\n").labels.set_index("recording")
    assert labels["speed_rpm"].to_dict() == pytest.approx({"absent": 1480.0, "dead": 1480.0, "pulsing": 1500.0})
    assert labels["speed_basis"].to_dict() == {"absent": "nominal", "dead": "nominal", "pulsing": "tach"}


def test_without_a_nominal_speed_a_tach_must_be_there_and_pulse(bring: Bring, mat: Mat) -> None:
    mat("a.mat", tacho=np.zeros(400))
    with pytest.raises(BadInput, match=r'a\.mat: tach\.variable = "tacho": 0 pulses'):
        bring(TACH)
    mat("a.mat")
    for nominal in ("", 'nominal_speed_rpm = {variable = "plate"}\n'):  # which the file does not hold
        with pytest.raises(BadInput, match=r'a\.mat: tach\.variable = "tacho": the file has no such variable'):
            bring(TACH + nominal)


@pytest.mark.parametrize(("nominal", "agrees"), [(1251, True), (1249, False), (1874, True), (1876, False), (0, False)])
def test_a_tach_is_refused_that_is_a_fifth_of_the_nominal_speed_off(
    bring: Bring, mat: Mat, nominal: int, agrees: bool
) -> None:
    mat("a.mat", tacho=PULSES)  # 1500 rpm, a fifth above 1250 and a fifth below 1875
    spec = TACH + f"cut_s = 0.2\nnominal_speed_rpm = {nominal}\n"
    if agrees:
        assert bring(spec).labels["speed_rpm"].tolist() == pytest.approx([1500.0] * 2)
        return
    message = (
        rf"a\.mat: tach\.pulses_per_rev = 1\.0: its pulses give 1500 .*, but nominal_speed_rpm = {nominal}; allowed"
    )
    with pytest.raises(BadInput, match=message):
        bring(spec)


def test_a_piece_of_a_changing_speed_may_be_far_off_the_nominal_one(bring: Bring, mat: Mat) -> None:
    slow_then_fast = np.concatenate([np.tile([0.0] * 39 + [1.0], 5), np.tile([0.0] * 19 + [1.0], 10)])
    mat("a.mat", tacho=slow_then_fast)  # 15 pulses in 0.4 s, 14 periods from 39.5 to 399.5 ms
    corpus = bring(TACH + "cut_s = 0.2\nnominal_speed_rpm = 2300\n")
    assert corpus.labels["speed_rpm"].tolist() == pytest.approx([1500.0, 3000.0])


def test_the_edges_of_a_recording_are_looked_for_once_however_many_its_pieces(
    bring: Bring, mat: Mat, monkeypatch: pytest.MonkeyPatch
) -> None:
    looked = []

    def counting(pulses: np.ndarray, threshold: float | None = None) -> np.ndarray:
        looked.append(pulses.size)
        return rising_edges(pulses, threshold)

    mat("a.mat", tacho=np.tile([0.0, 0.0, 0.0, 0.0, 1.0], 80))
    monkeypatch.setattr("datagen.recordings.pulse_times.rising_edges", counting)
    corpus = bring(
        '[[recording]]\nname = "all"\nfiles = "a.mat"\nunit = "g"\nrate_hz = 1000\ny = "sig"\ncut_s = 0.05\n'
        'tach = {variable = "tacho"}\n'
    )
    assert len(corpus) == 8
    assert looked == [400, 400]  # once to check it, once to write it


def course(time: np.ndarray) -> np.ndarray:
    """Turns of a shaft that goes from 10 to 20 turns a second and swings once a second."""
    return 10.0 * time + 5.0 * time**2 + 0.2 * np.sin(2.0 * np.pi * time)


@pytest.mark.parametrize(("pulses", "allowed"), [(1, 0.02), (60, 2e-4)])
def test_the_angle_of_a_shaft_is_told_by_its_pulses_and_goes_on_beyond_them(pulses: int, allowed: float) -> None:
    fine = np.linspace(0.0, 1.0, 2_000_001)
    numbers = np.arange(np.ceil(course(np.array(0.08)) * pulses), course(np.array(0.93)) * pulses)
    times = np.interp(numbers / pulses, course(fine), fine)
    instants = np.arange(4096) / 4096.0
    off = shaft_angle(times, pulses, instants) / (2.0 * np.pi) - course(instants)
    between = (instants > times[0]) & (instants < times[-1])
    off -= off[between].mean()
    # Between pulses of one turn speed changes by a tenth: an eighth of that, in turns, is what a chord may miss.
    assert np.abs(off[between]).max() < allowed
    # Beyond the pulses the speed of the nearest turn goes on, which by then is a few per cent off.
    assert np.abs(off).max() < 0.15
    assert (np.diff(off + course(instants)) > 0.0).all()


def test_beyond_its_pulses_a_shaft_goes_on_at_the_mean_speed_of_a_turn_of_unequal_teeth() -> None:
    teeth = np.array([0.0, 0.2, 0.5, 0.7])
    times = (np.arange(5)[:, None] + teeth).ravel()  # one turn a second
    before, behind = shaft_angle(times, 4.0, np.array([-0.5, 4.7 + 0.5])) / (2.0 * np.pi)
    assert before == pytest.approx(-0.5)
    assert behind == pytest.approx(4.75 + 0.5)


def test_beyond_fewer_pulses_than_a_turn_has_a_shaft_goes_on_at_their_mean_speed() -> None:
    times = np.array([1.0, 1.01, 1.03, 1.04])  # three of sixty teeth in 0.04 s
    before, behind = shaft_angle(times, 60.0, np.array([0.0, 2.04])) / (2.0 * np.pi)
    assert before == pytest.approx(-1.25)
    assert behind == pytest.approx(0.05 + 1.25)


def test_a_shaft_is_steady_if_it_strays_by_less_than_a_tenth_of_a_turn() -> None:
    time = np.linspace(0.0, 1.0, 1000)
    for strays, steady in ((0.09, True), (0.11, False)):
        turns = 30.0 * time + strays * np.sin(2.0 * np.pi * time)
        assert is_steady(2.0 * np.pi * turns) == steady


def test_the_angle_of_the_shaft_is_stored_where_a_tach_says_that_the_speed_changes(bring: Bring, mat: Mat) -> None:
    time = np.arange(8000) / 4000.0
    for name, start, stop in (("even", 15.0, 15.0), ("speeding", 10.0, 20.0)):
        turns = start * time + 0.25 * (stop - start) * time**2
        noise = np.random.default_rng(int(start)).standard_normal(time.size)
        mat(f"{name}.mat", noise, tacho=(np.modf(16.0 * turns)[0] < 0.5).astype(float))
    spec = (
        '[[recording]]\nname = "all"\nfiles = "*.mat"\nunit = "g"\nrate_hz = 4000\ny = "sig"\n'
        'tach = {variable = "tacho", pulses_per_rev = 16}\n'
    )
    corpus = bring(spec, "whole")
    even, speeding = corpus.labels.set_index("recording").loc[["even", "speeding"], "record"]
    assert not corpus.has(even, "shaft_angle")
    # The pulses are known to a sample of 0.25 ms, in which the shaft turns by up to a 200th of a turn.
    angle = corpus.waveform(speeding, "shaft_angle")
    assert np.allclose(angle, 2.0 * np.pi * (10.0 * time + 2.5 * time**2), atol=2.0 * np.pi * 20.0 / 4000.0)
    assert check_corpus(corpus.folder).sound
    # A piece begins at zero; its speed changes by a tenth, still more than even turning.
    cut = bring(spec + "cut_s = 0.5\n", "cut")
    piece = int(cut.labels.set_index("recording").loc["speeding#1", "record"])
    part = cut.waveform(piece, "shaft_angle")
    assert part[0] == 0.0
    assert np.allclose(part, angle[2000:4000] - angle[2000], atol=2.0 * np.pi * 20.0 / 4000.0)


def test_the_mean_of_a_changing_speed_is_that_of_the_angle_and_not_of_the_span_of_the_pulses(
    bring: Bring, mat: Mat
) -> None:
    """From 2 to 22 turns a second in 2 s: the first of 24 pulses comes after 0.36 s."""
    time = np.arange(8000) / 4000.0
    pulses = (np.modf(2.0 * time + 5.0 * time**2)[0] < 0.2).astype(float)
    mat("a.mat", np.random.default_rng(3).standard_normal(time.size), tacho=pulses)
    corpus = bring(
        '[[recording]]\nname = "all"\nfiles = "*.mat"\nunit = "g"\nrate_hz = 4000\ny = "sig"\n'
        'tach = {variable = "tacho", pulses_per_rev = 1}\n'
    )
    turned = corpus.waveform(0, "shaft_angle")[-1]
    mean = float(corpus.labels["speed_rpm"].iloc[0])
    assert mean == pytest.approx(turned / (2.0 * np.pi) / time[-1] * 60.0, rel=1e-6)
    assert mean == pytest.approx(12.0 * 60.0, rel=0.03)  # between its pulses it turns at 14.0 a second


def test_a_channel_of_a_changing_speed_is_summed_up_to_the_angle(bring: Bring, mat: Mat) -> None:
    time = np.arange(8000) / 4000.0
    rpm = 600.0 + 300.0 * (np.arange(400) + 0.5) / 200.0  # from 10 to 20 turns a second in two seconds
    mat(
        "a.mat", np.random.default_rng(1).standard_normal(time.size), rpm=rpm, steady=np.full(400, 900.0),
        khz=rpm / 60e3, swinging=np.concatenate([[-1.0], rpm[1:]]),
    )  # fmt: skip
    spec = 'files = "a.mat"\nunit = "g"\nrate_hz = 4000\ny = "sig"\n'
    corpus = bring(
        'same_samples = "keep"\n'
        f'[[recording]]\nname = "a"\nrecording = "a"\n{spec}speed_rpm = {{variable = "rpm"}}\n'
        f'[[recording]]\nname = "b"\nrecording = "b"\n{spec}speed_rpm = {{variable = "steady"}}\n'
        f'[[recording]]\nname = "c"\nrecording = "c"\n{spec}cut_s = 0.5\nspeed_rpm = {{variable = "rpm"}}\n'
        f'[[recording]]\nname = "d"\nrecording = "d"\n{spec}speed_rpm = {{variable = "khz", factor = 60e3}}\n'
        f'[[recording]]\nname = "e"\nrecording = "e"\n{spec}speed_rpm = {{variable = "swinging"}}\n'
    )
    angle = corpus.waveform(0, "shaft_angle")
    assert np.allclose(angle, 2.0 * np.pi * (10.0 * time + 2.5 * time**2), atol=1e-3)
    assert not corpus.has(1, "shaft_angle")
    assert np.allclose(corpus.waveform(5, "shaft_angle"), angle[6000:] - angle[6000], atol=1e-9)
    assert np.allclose(corpus.waveform(6, "shaft_angle"), angle, atol=1e-9)
    assert not corpus.has(7, "shaft_angle")  # of a shaft that seems to turn backwards


def test_a_vibration_is_not_taken_for_a_tach(bring: Bring, mat: Mat) -> None:
    vibration = np.random.default_rng(2).standard_normal(4000)
    mat("a.mat", vibration, tacho=vibration)
    with pytest.raises(BadInput, match="pulses of its tach are missing or double") as refused:
        bring(TACH.replace("1000", "2500"))
    assert refused.value.field == "tach.variable"


@pytest.mark.parametrize("others", [[], [27, 30, 33]])
def test_a_tach_of_a_shaft_that_stands_for_long_is_refused_for_that(others: list[int], bring: Bring, mat: Mat) -> None:
    pulses = np.tile([0.0] * 99 + [1.0], 40)
    pulses[500:2500] = 0.0
    pulses[100 * np.array(others, dtype=int) + 99] = 0.0
    mat("a.mat", np.random.default_rng(2).standard_normal(4000), tacho=pulses)
    with pytest.raises(BadInput, match="none of its pulses is from") as refused:
        bring(TACH.replace("1000", "2500"))
    assert "is from 0.1994 to 1.039 s, where 20 would be if the shaft did not stand there" in str(refused.value)
    assert "nominal_speed_rpm" in str(refused.value)


@pytest.mark.parametrize("wrong", [[], [37], [5, 20, 33]])
def test_a_steady_shaft_whose_tach_loses_a_pulse_stays_steady(bring: Bring, mat: Mat, wrong: list[int]) -> None:
    pulses = np.tile([0.0] * 99 + [1.0], 40)  # 25 turns a second, one pulse a turn
    pulses[np.array(wrong, dtype=int) * 100 + 99] = 0.0
    mat("a.mat", np.random.default_rng(1).standard_normal(pulses.size), tacho=pulses)
    corpus = bring(TACH.replace("1000", "2500"))
    assert corpus.labels["speed_rpm"].tolist() == pytest.approx([1500.0])
    assert not corpus.has(0, "shaft_angle")
    provenance = json.loads(corpus.waveform(0, "provenance"))
    assert provenance.get("mended_pulses", 0) == len(wrong)


def test_a_list_of_the_times_of_pulses_needs_to_be_told_and_an_angle_is_no_tach(bring: Bring, mat: Mat) -> None:
    mat("a.mat", tacho=np.arange(1, 20) * 0.02)
    with pytest.raises(BadInput, match=r"holds 19 samples, the vibration 400; .*, or tach\.times = true if these are"):
        bring(TACH)
    mat("a.mat", tacho=np.arange(400) * 0.3)
    with pytest.raises(BadInput, match=r"1 pulse from 0 to 0\.4 s; .*, and an angle that only grows shows none"):
        bring(TACH)


def test_a_gap_in_the_course_of_a_speed_comes_with_a_way_out(bring: Bring, mat: Mat) -> None:
    mat("a.mat", rpm=np.where(np.arange(400) == 7, np.nan, 1500.0))
    with pytest.raises(BadInput, match=r"1 of 400 samples .*; allowed: finite numbers throughout, as missing_samples"):
        bring(TACH.replace('tach = {variable = "tacho"}', 'speed_rpm = {variable = "rpm"}'))


LISTED = TACH.replace('"tacho"', '"tacho", times = true')


def test_the_times_of_pulses_give_speed_and_angle_as_a_channel_of_them_does(bring: Bring, mat: Mat) -> None:
    turns = np.arange(0.0, 8.0, 0.5)  # two pulses a turn, 0.4 s in which the shaft goes from 10 to 30 turns a second
    times = (np.sqrt(100.0 + 100.0 * turns) - 10.0) / 50.0
    mat("a.mat", tacho=times * 1e3)
    corpus = bring(LISTED.replace("times = true", "times = true, factor = 1e-3, pulses_per_rev = 2"))
    # Behind the last pulse, at 7.5 turns, it goes on at the speed of the last turn, up to the last sample.
    turned = 7.5 + (0.399 - times[-1]) / (times[-1] - times[-3])
    assert corpus.labels["speed_rpm"].tolist() == pytest.approx([60.0 * turned / 0.399])
    assert corpus.labels["speed_basis"].tolist() == ["tach"]
    instants = np.arange(400) / 1000.0
    turned = 2.0 * np.pi * (10.0 * instants + 25.0 * instants**2)
    assert corpus.waveform(0, "shaft_angle") == pytest.approx(turned, abs=0.15)


def test_the_times_of_pulses_are_by_the_clock_of_the_vibrations_samples(bring: Bring, mat: Mat) -> None:
    mat("a.mat", t=100.0 + np.arange(400) / 1000.0, tacho=np.arange(99.0, 102.0, 0.04))
    spec = LISTED.replace("rate_hz = 1000", 'rate_hz = {variable = "t", times = true}')
    assert bring(spec).labels["speed_rpm"].tolist() == pytest.approx([1500.0])
    mat("a.mat", t=1e5 + np.arange(400), tacho=np.arange(99.0, 102.0, 0.04))
    assert bring(spec.replace("times = true}", "times = true, factor = 1e-3}", 1), "ms").labels[
        "speed_rpm"
    ].tolist() == (pytest.approx([1500.0]))
    with pytest.raises(BadInput, match=r"its pulses are from 99 to 10\d s after the first sample, .* lasts 0\.4 s"):
        bring(LISTED, "other clock")


def test_a_column_of_the_times_of_pulses_may_be_shorter_than_the_others(bring: Bring, tmp_path: Path) -> None:
    table = tmp_path / "a.csv"
    rows = [f"{k % 7},{0.02 * k if k < 20 else ''}" for k in range(400)]
    table.write_text("\n".join(["sig,tacho", *rows]))
    spec = LISTED.replace("*.mat", "*.csv")
    assert bring(spec).labels["speed_rpm"].tolist() == pytest.approx([3000.0])
    table.write_text("\n".join(["sig,tacho", *rows[:5], "1,late", *rows[6:]]))
    with pytest.raises(BadInput, match=r"a\.csv, line 7: tach\.variable = .*; allowed: times alone"):
        bring(spec, "a word among them")


@pytest.mark.parametrize(
    ("tach", "message"),
    [
        ("times = true, rate_hz = 100", "times of pulses have neither a sampling rate nor a threshold"),
        ("times = true, threshold = 1", "times of pulses have neither a sampling rate nor a threshold"),
        ("factor = 0.001", "it brings times to s, and this is a channel"),
        ("times = true, factor = -1", "allowed: above 0"),
    ],
)
def test_settings_of_a_tach_that_do_not_go_together_are_refused(
    bring: Bring, mat: Mat, tach: str, message: str
) -> None:
    mat("a.mat", tacho=np.arange(1, 20) * 0.02)
    with pytest.raises(BadInput, match=message):
        bring(TACH.replace('"tacho"', f'"tacho", {tach}'))


def test_times_of_pulses_that_do_not_rise_are_refused(bring: Bring, mat: Mat) -> None:
    mat("a.mat", tacho=np.array([0.1, 0.2, 0.2, 0.3]))
    with pytest.raises(BadInput, match=r"tach\.variable = \"tacho\": 0\.2 follows 0\.2; allowed: times that rise"):
        bring(LISTED)


def test_a_part_in_which_the_shaft_turns_is_taken_of_a_recording_in_which_it_rests(bring: Bring, mat: Mat) -> None:
    pulses = np.zeros(400)
    pulses[5:100:5] = pulses[300:400:10] = 1.0  # 12000 rpm, a rest, 6000 rpm
    mat("a.mat", tacho=pulses)
    with pytest.raises(BadInput, match=r"the part before or behind that alone \(from_s, to_s\)"):
        bring(TACH)
    before, behind = bring(TACH + "to_s = 0.1\n", "before"), bring(TACH + "from_s = 0.29\ncut_s = 0.055\n", "behind")
    assert before.labels["speed_rpm"].tolist() == pytest.approx([12000.0])
    assert before.labels["duration_s"].tolist() == pytest.approx([0.1])
    assert behind.labels["recording"].tolist() == ["a#0", "a#1"]
    assert behind.labels["speed_rpm"].tolist() == pytest.approx([6000.0, 6000.0])
    places = [json.loads(behind.waveform(record, "provenance"))["first_sample"] for record in (0, 1)]
    assert places == [290, 345]


def test_a_tach_whose_pulses_give_a_speed_that_no_shaft_has_is_refused(bring: Bring, mat: Mat) -> None:
    mat("a.mat", tacho=PULSES)
    message = r"a\.mat: tach\.pulses_per_rev = 0\.001: its pulses give 1\.5e\+06 revolutions per minute; allowed"
    with pytest.raises(BadInput, match=message):
        bring(TACH.replace('"tacho"', '"tacho", pulses_per_rev = 0.001'))


@pytest.mark.parametrize("lost", [8, 9])
def test_a_tenth_of_the_pulses_of_a_tach_may_be_wrong(bring: Bring, mat: Mat, lost: int) -> None:
    pulses = np.tile([0.0] * 49 + [1.0], 80)
    pulses[np.arange(1, lost + 1) * 400 + 49] = 0.0
    mat("a.mat", np.random.default_rng(1).standard_normal(pulses.size), tacho=pulses)
    if lost == 8:
        assert bring(TACH).labels["speed_rpm"].tolist() == pytest.approx([1200.0])
        return
    with pytest.raises(BadInput, match="9 of the 80 pulses of its tach are missing or double"):
        bring(TACH)


@pytest.mark.parametrize("factor", [1.0, -1.0])
def test_a_channel_of_speed_counts_with_its_factor(factor: float, bring: Bring, mat: Mat) -> None:
    speeds = np.linspace(600.0, 1800.0, 2000)
    mat("run.mat", np.random.default_rng(1).standard_normal(8000), speed=factor * speeds[:, None])
    corpus = bring(
        '[[recording]]\nname = "all"\nfiles = "*.mat"\nunit = "g"\nrate_hz = 4000\ny = "sig"\n'
        f'speed_rpm = {{variable = "speed", factor = {factor}}}\n'
    )
    assert corpus.labels["speed_rpm"][0] == pytest.approx(1200.0, rel=1e-3)
    # 2 s at 20 turns a second on average, from 10 to 30.
    assert corpus.waveform(0, "shaft_angle")[-1] / (2.0 * np.pi) == pytest.approx(40.0, rel=1e-3)


def test_the_first_time_that_falls_is_told(bring: Bring, mat: Mat) -> None:
    mat("a.mat", tacho=np.array([0.1, 0.3, 0.2, 0.25, 0.15]))
    with pytest.raises(BadInput, match=r"0\.2 follows 0\.3; allowed: times that rise"):
        bring(LISTED)


def test_a_gap_among_the_times_of_pulses_is_no_end_of_them(bring: Bring, mat: Mat) -> None:
    mat("a.mat", tacho=np.array([0.1, np.nan, 0.2, 0.3, np.nan]))
    with pytest.raises(BadInput, match=r"2 of 5 samples are not finite numbers, the first at sample 1 .*times alone"):
        bring(LISTED)


def test_words_behind_the_times_of_pulses_are_no_empty_cells(bring: Bring, tmp_path: Path) -> None:
    rows = [f"{k % 7},{0.02 * k if k < 20 else '' if k < 399 else 'end'}" for k in range(400)]
    (tmp_path / "a.csv").write_text("\n".join(["sig,tacho", *rows]))
    with pytest.raises(BadInput, match=r"380 of 400 cells are not finite numbers.*; allowed: times alone"):
        bring(LISTED.replace("*.mat", "*.csv"))

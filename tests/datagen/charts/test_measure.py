"""What is measured for a chart, and what is stored of it."""

import csv
import dataclasses
import json
import math

import pytest

from datagen.charts import contestants as entrants
from datagen.charts import measure as measuring
from datagen.charts.measure import Run, at_error
from datagen.charts.response_errors import ResponseErrors
from datagen.charts.scenes import find_subject
from datagen.charts.table import COLUMNS, chart_table
from datagen.drawing.work_precision import (
    work_precision_png,
)
from datagen.files.plain import plain_json
from physics.modes import coupled_resonator_frequency, rated_matrices
from physics.reference_scenes import reference_scene

RATE = 65536.0
PNG = b"\x89PNG\r\n"


def test_speed_at_an_error_is_read_between_runs_on_logarithms():
    def made(error, speed):
        scored = ResponseErrors(error, 0.0, 0.0, 0.0, 0.0, 0, 0.0)
        return Run("method", "m", "", 1.0, 1.0 / speed, speed, scored, "")

    runs = [made(1e-2, 100.0), made(1e-4, 1.0)]
    assert at_error(runs, "m", 1e-3) == pytest.approx(10.0, rel=1e-12)
    assert at_error(runs, "m", 1e-5) is None
    assert at_error(runs, "m", 0.1) == 100.0
    assert at_error(runs, "other", 1e-3) is None


def test_a_chart_holds_every_run_with_machine_and_versions(small_chart):
    assert {run.name for run in small_chart.runs} == {"exponential_rk4", "impulse train"}
    first = small_chart.runs[0]
    assert first.real_time == pytest.approx(first.duration / first.seconds, rel=1e-12)
    assert first.score.acceleration < 1e-3  # the goal of the reference scenes
    assert set(small_chart.edges) == {"exponential_rk4"}
    assert small_chart.made_with["numba"]


def test_a_chart_says_on_what_it_was_measured(small_chart):
    assert {"processor", "cores", "physics"} <= set(small_chart.made_with)


def test_what_is_timed_has_been_run_whole_before_unless_that_is_slow(monkeypatch):
    durations = []
    clock = iter([0.0, 0.4, 1.0, 1.1, 2.0, 2.1, 3.0, 3.1])
    monkeypatch.setattr(measuring.time, "process_time", lambda: next(clock))
    one = entrants.Contestant("g", "n", "s", lambda scene, rate: durations.append(scene.duration), lambda *_: None)
    assert measuring.timed(one, reference_scene("F1", 0.5), RATE, rounds=3)[0] == pytest.approx(0.1)
    assert durations == [0.5] * 4  # the first, of 0.4 s, does not count
    clock = iter([0.0, 0.6])
    assert measuring.timed(one, reference_scene("F1", 0.5), RATE, rounds=3)[0] == pytest.approx(0.6)
    assert durations == [0.5] * 5


def test_every_round_that_is_asked_for_is_run(monkeypatch):
    durations = []
    clock = (0.3 * ((k + 1) // 2) for k in range(20))
    monkeypatch.setattr(measuring.time, "process_time", lambda: next(clock))
    one = entrants.Contestant("g", "n", "s", lambda scene, rate: durations.append(scene.duration), lambda *_: None)
    measuring.timed(one, reference_scene("F1", 0.5), RATE, rounds=5)
    assert durations == [0.5] * (1 + 5)


def test_what_is_short_is_repeated_until_a_tenth_of_a_second_is_spent(monkeypatch):
    durations = []
    clock = (0.03 * ((k + 1) // 2) for k in range(20))
    monkeypatch.setattr(measuring.time, "process_time", lambda: next(clock))
    one = entrants.Contestant("g", "n", "s", lambda scene, rate: durations.append(scene.duration), lambda *_: None)
    assert measuring.timed(one, reference_scene("F1", 0.5), RATE, rounds=2)[0] == pytest.approx(0.03)
    assert durations == [0.5] * (1 + 4)


def test_a_chart_says_what_each_method_and_model_on_it_is_for_and_where_it_holds(small_chart):
    assert {run.name for run in small_chart.runs} < set(small_chart.contracts)
    assert small_chart.contracts["exponential_rk4"]["order"] == 4.0
    for statement in ("computes", "holds_where", "leaves_out"):
        assert len(str(small_chart.contracts["impulse train"][statement]).split()) > 5
    written = json.loads(plain_json(small_chart))["contracts"]
    assert written["impulse train"]["rings"] is True
    assert written["modal"]["stability_limit"] is None  # NaN: none stated
    assert small_chart.best["exponential_rk4"] > small_chart.runs[1].real_time / 2.0
    assert work_precision_png(small_chart).startswith(PNG)


def test_the_table_has_a_row_for_every_run(small_chart):
    rows = list(csv.reader(chart_table(small_chart).splitlines()))
    assert tuple(rows[0]) == COLUMNS
    assert len(rows) == 1 + len(small_chart.runs)
    assert all(len(row) == len(COLUMNS) for row in rows)


def test_every_number_of_a_run_stands_in_its_own_column(small_chart):
    scored = ResponseErrors(1e-3, 0.2, 3.0, 4.0, 5.0, 6, 7e-3)
    run = Run("method", "m", "2 steps a sample", 0.5, 0.25, 2.0, scored, "")
    names, row = csv.reader(chart_table(dataclasses.replace(small_chart, runs=(run,))).splitlines())
    assert dict(zip(names, row, strict=True)) == {
        "group": "method", "name": "m", "setting": "2 steps a sample", "duration_s": "0.5", "seconds": "0.25",
        "times_real_time": "2", "acceleration_error": "0.001", "envelope_error_db": "0.2", "release_error_us": "3",
        "regain_error_us": "4", "worst_event_error_us": "5", "events_missed": "6", "stiffness_error": "0.007",
        "failure": "",
    }  # fmt: skip


def test_a_slow_solver_is_timed_on_the_first_part_and_over_that_alone(monkeypatch):
    subject = find_subject("F1")
    slow = dataclasses.replace(entrants.contestants(subject.scene, quick=True)[0], part=True)
    monkeypatch.setattr(measuring, "contestants", lambda scene, quick: [slow])
    (run,) = measuring.measure(subject, quick=True, rounds=1, step=lambda what: None).runs
    assert run.duration == pytest.approx(0.15)  # 0.05 s are scored, which hold three passes
    assert run.real_time == pytest.approx(run.duration / run.seconds, rel=1e-12)


def test_an_edge_is_the_speed_at_the_longest_stable_step_however_fine_the_run_it_is_told_from():
    scene, name = reference_scene("F1", 0.1), "runge_kutta4"
    # A step of one sample at ten times real time, or of a quarter of it at 2.5 times: the same cost a step.
    runs = [Run("method", name, f"{steps} steps", 0.1, 0.01 * steps, 10.0 / steps, None, "", steps) for steps in (1, 4)]
    one, four = (measuring.stability_edges(scene, RATE, [run])[name] for run in runs)
    assert one == pytest.approx(four, rel=1e-12)
    # The classical method holds an undamped mode to 2.83 and modes with up to 30 % of damping to 2.59 at least; the
    # fastest mode of the fan rig is that of its resonator on the rings.
    fastest = 2.0 * math.pi * coupled_resonator_frequency(scene.rig, rated_matrices(scene.rig)[0])
    assert 2.5 < one / 10.0 / RATE * fastest < 2.9


def test_the_speed_at_an_error_is_told_of_a_method_without_any_error_too():
    def made(error, speed):
        return Run("method", "m", "", 1.0, 1.0 / speed, speed, ResponseErrors(error, 0.0, 0.0, 0.0, 0.0, 0, 0.0), "")

    assert 90.0 < at_error([made(1e-2, 100.0), made(0.0, 1.0)], "m", 1e-3) < 100.0
    assert at_error([made(0.0, 1.0)], "m", 1e-3) == 1.0

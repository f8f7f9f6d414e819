"""The chart: which scene it is of, what is scored, what is written, and what bad input says."""

import csv
import dataclasses
import json
import math

import numpy as np
import pytest

from datagen.charts import contestants as entrants
from datagen.charts import stability
from datagen.charts.files import COLUMNS, chart_table
from datagen.charts.measure import Run, at_error, measure
from datagen.charts.response import of_states, of_trace
from datagen.charts.scenes import find_subject
from datagen.charts.scores import Score, score
from datagen.cli import app
from datagen.drawing.stability_map import kind, stability_png
from datagen.drawing.style import house_style, plt
from datagen.drawing.work_precision import draw_work_precision, work_precision_png
from datagen.errors import BadInput
from datagen.plain import plain_json
from physics.integrators.general_purpose import BALL_BY_BALL, CONTACT_KERNEL, PAIRS, integrate_compiled
from physics.reference_scenes import REFERENCE_SCENES, reference_scene
from physics.simulate import simulate

RATE = 65536.0
PNG = b"\x89PNG\r\n"


def run_command(*arguments):
    from typer.testing import CliRunner

    done = CliRunner().invoke(app, [str(argument) for argument in arguments], catch_exceptions=False)
    return done.exit_code, done.stdout, done.stderr


@pytest.fixture(scope="module")
def response():
    """The fan rig's line spall over 0.2 s with its states."""
    scene = reference_scene("F1", 0.2)
    trace = simulate(scene, RATE, method="exponential_rk4", substeps=2, estimate_error=False, keep_state=True)
    return scene, trace


@pytest.fixture(scope="module")
def small_chart():
    """A chart of one method and one compiled solver over 0.12 s."""
    subject = find_subject("F1", 0)
    subject = dataclasses.replace(subject, scene=subject.lasting(0.12))
    chosen = [
        one
        for one in entrants.contestants(subject.scene, quick=True)
        if one.name in ("exponential_rk4", "impulse train")
    ]
    original, entrants_of = entrants.contestants, lambda scene, quick: chosen
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("datagen.charts.measure.contestants", entrants_of)
        chart = measure(subject, quick=True, rounds=1, told=lambda what: None)
    assert entrants.contestants is original
    return chart


@pytest.mark.parametrize("name", REFERENCE_SCENES)
def test_every_reference_scene_can_be_charted_by_name(name):
    subject = find_subject(name, 0)
    assert subject.scene.duration == 0.5
    assert subject.rate == RATE
    assert subject.scene.rig.name == {"G": "gearbox", "F": "fan"}[name[0]]


def test_a_speed_is_given_after_an_at_sign():
    fast = find_subject("G1@3", 0)
    assert fast.name == "G1_3x"
    assert fast.scene.operation.shaft_speed == pytest.approx(3.0 * fast.scene.rig.rated_speed, rel=1e-15)
    assert "1260 rpm" in fast.title


def test_a_record_of_a_recipe_can_be_charted(tiny_recipe):
    with pytest.raises(BadInput, match="lasts"):
        find_subject(str(tiny_recipe), 0)
    subject = find_subject("datasets/quickstart", 3)
    assert subject.name == "quickstart_3"
    assert subject.scene.duration <= 0.5


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("chart", "G9", "--out", "OUT"), "G0, G1, G1s"),
        (("chart", "G1@fast", "--out", "OUT"), "G1@0.01 to G1@100"),
        (("chart", "nowhere.toml", "--out", "OUT"), "nowhere.toml"),
        (("chart", "G1"), "--out"),
        (("chart", "--out", "OUT"), "--stability"),
        (("chart", "G1", "--stability", "--out", "OUT"), "--stability"),
        (("chart", "G1", "--out", "OUT", "--rounds", "0"), "--rounds"),
        (("chart", "datasets/quickstart", "--record", "99999", "--out", "OUT"), "record"),
    ],
)
def test_bad_input_ends_with_2_and_nothing_is_written(arguments, words, tmp_path):
    out = tmp_path / "out"
    code, _, told = run_command(*(str(out) if argument == "OUT" else argument for argument in arguments))
    assert code == 2, told
    assert words in told
    assert not out.exists()


def test_a_response_scored_against_itself_has_no_error(response):
    scene, trace = response
    found = score(scene, RATE, of_trace(trace), of_trace(trace))
    assert found == Score(0.0, 0.0, 0.0, 0.0, 0.0, 0, 0.0)


def test_a_response_one_percent_too_large_is_one_percent_and_a_sixth_of_a_decibel_off(response):
    scene, trace = response
    larger = dataclasses.replace(of_trace(trace), acceleration=1.01 * trace.acceleration)
    found = score(scene, RATE, larger, of_trace(trace))
    assert found.acceleration == pytest.approx(0.01, rel=1e-9)
    assert found.envelope_db == pytest.approx(20.0 * math.log10(1.01), rel=1e-6)  # a squared envelope
    assert found.stiffness == 0.0


def test_late_contact_changes_are_late_by_as_much(response):
    scene, trace = response
    late = dataclasses.replace(trace.changes, time=trace.changes.time + 3e-6)
    found = score(scene, RATE, dataclasses.replace(of_trace(trace), changes=late), of_trace(trace))
    assert found.release_us == pytest.approx(3.0, rel=1e-6)
    assert found.regain_us == pytest.approx(3.0, rel=1e-6)
    assert found.worst_event_us == pytest.approx(3.0, rel=1e-6)


def test_what_is_not_finite_is_infinitely_wrong(response):
    scene, trace = response
    broken = dataclasses.replace(of_trace(trace), acceleration=np.full_like(trace.acceleration, np.nan))
    assert score(scene, RATE, broken, of_trace(trace)).acceleration == math.inf


@pytest.mark.parametrize("kind_of_slope", [BALL_BY_BALL, CONTACT_KERNEL])
@pytest.mark.parametrize("pair", PAIRS)
def test_the_compiled_rivals_reach_the_same_response_without_locating_anything(pair, kind_of_slope):
    scene = reference_scene("F1", 0.03)
    exact = simulate(scene, RATE, method="exponential_rk4", substeps=16, estimate_error=False)
    samples = exact.time.size
    start = entrants.start_of(scene)
    states, evaluations = integrate_compiled(scene, pair, kind_of_slope, start, RATE, samples, 1e-8)
    found = of_states(scene, RATE, states)
    size = np.sqrt(np.mean(exact.acceleration**2))
    assert np.sqrt(np.mean((found.acceleration - exact.acceleration) ** 2)) < 1e-3 * size  # steps over jumps of force
    assert evaluations > 8 * samples  # a dozen stages for a step of about a sample
    loose, fewer = integrate_compiled(scene, pair, kind_of_slope, start, RATE, samples, 1e-4)
    assert fewer < evaluations
    assert not np.array_equal(loose, states)


@pytest.mark.parametrize("kind_of_slope", [BALL_BY_BALL, CONTACT_KERNEL])
@pytest.mark.parametrize("solver", entrants.NUMBALSODA)
def test_numbalsoda_reaches_the_same_response_where_it_is_installed(solver, kind_of_slope):
    pytest.importorskip("numbalsoda", reason="numbalsoda needs a Fortran compiler to install")
    scene = reference_scene("F1", 0.03)
    exact = simulate(scene, RATE, method="exponential_rk4", substeps=16, estimate_error=False)
    name = f"numbalsoda {solver}, {kind_of_slope}"
    finest = [one for one in entrants.contestants(scene, quick=False) if one.name == name][-1]
    found = finest.read(scene, RATE, finest.run(scene, RATE))
    size = np.sqrt(np.mean(exact.acceleration**2))
    assert np.sqrt(np.mean((found.acceleration - exact.acceleration) ** 2)) < 1e-3 * size  # steps over jumps of force


def test_numbalsoda_takes_part_only_where_it_is_installed(monkeypatch):
    monkeypatch.setattr(entrants, "find_spec", lambda name: None)
    names = {one.name for one in entrants.contestants(reference_scene("F1", 0.03), quick=True)}
    assert not any("numbalsoda" in name for name in names)
    assert f"compiled DOP853, {CONTACT_KERNEL}" in names


def test_speed_at_an_error_is_read_between_runs_on_logarithms():
    def made(error, speed):
        scored = Score(error, 0.0, 0.0, 0.0, 0.0, 0, 0.0)
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


def test_a_chart_says_what_each_method_and_model_on_it_is_for_and_where_it_holds(small_chart):
    assert {run.name for run in small_chart.runs} < set(small_chart.contracts)
    assert small_chart.contracts["exponential_rk4"]["order"] == 4.0
    for statement in ("computes", "holds_where", "leaves_out"):
        assert len(str(small_chart.contracts["impulse train"][statement]).split()) > 5
    written = json.loads(plain_json(small_chart))["contracts"]
    assert written["impulse train"]["rings"] is True
    assert written["modal"]["stability_limit"] is None  # infinite
    assert small_chart.best["exponential_rk4"] > small_chart.runs[1].real_time / 2.0
    assert work_precision_png(small_chart).startswith(PNG)


def test_the_table_has_a_row_for_every_run(small_chart):
    rows = list(csv.reader(chart_table(small_chart).splitlines()))
    assert tuple(rows[0]) == COLUMNS
    assert len(rows) == 1 + len(small_chart.runs)
    assert all(len(row) == len(COLUMNS) for row in rows)


def test_maps_tell_accurate_from_wrong_refused_and_unanswerable(monkeypatch, tmp_path):
    small = dataclasses.replace(stability.SWEEPS[0], values=(1.0, 1e5))
    monkeypatch.setattr(stability, "SWEEPS", (small,))
    monkeypatch.setattr(stability, "MARCHES", {"exponential_rk4": None})
    monkeypatch.setattr(stability, "DURATION", 0.02)
    code, shown, _ = run_command("chart", "--stability", "--out", tmp_path)
    assert code == 0
    assert "stability_maps.png" in shown
    maps = json.loads((tmp_path / "stability_maps.json").read_text())["maps"]
    chosen, fixed = maps
    assert chosen["method"] == "modal"
    asked = stability.ACCURACIES.index(1e-3)
    assert all(error < 1e-3 for error in (row[asked] for row in chosen["error"]))
    soft, stiff = fixed["error"]
    one_step = stability.STEPS.index(1.0)
    assert soft[one_step] < 1e-3  # the goal of the reference scenes
    assert fixed["limit"][0] > 1.0 > fixed["limit"][1]
    assert stiff[one_step] is None or stiff[one_step] > 0.1
    assert (tmp_path / "stability_maps.png").read_bytes().startswith(PNG)


def test_the_kinds_of_a_map_follow_the_size_of_the_error():
    assert [kind(error) for error in (5e-4, 5e-3, 5e-2, 0.5, math.inf, math.nan)] == [0, 1, 2, 3, 4, 5]
    one = stability.Map(
        "m",
        stability.BY_STEP,
        stability.STEPS,
        "s",
        "u",
        (1.0, 2.0),
        ((0.0,) * 8, (math.inf,) * 8),
        (math.inf, math.inf),
    )
    assert stability_png([one]).startswith(PNG)


def test_names_in_a_chart_do_not_lie_on_each_other(small_chart):
    speeds = {"exponential_rk4": 50.0, "exponential_adams4": 48.0, "runge_kutta4": 0.5}
    run = dict.fromkeys(("exponential_adams4", "runge_kutta4", "quasi-static"), small_chart.runs[0])
    model = next(one for one in small_chart.runs if one.group == entrants.MODEL)
    more = [dataclasses.replace(model if name == "quasi-static" else one, name=name) for name, one in run.items()]
    with house_style():
        figure = draw_work_precision(dataclasses.replace(small_chart, edges=speeds, runs=(*small_chart.runs, *more)))
        figure.canvas.draw()
        strip, panel = figure.axes
        boxes = [text.get_window_extent() for text in (*strip.texts, *panel.texts, *figure.texts)]
        named = [text.get_text() for text in panel.get_legend().get_texts()]
        plt.close(figure)
    assert len(boxes) == len(speeds) + 2
    assert not any(one.overlaps(other) for k, one in enumerate(boxes) for other in boxes[:k])
    assert not any(box.overlaps(panel.get_window_extent()) for box in boxes)
    assert {"model: impulse train", "model: quasi-static"} <= set(named)

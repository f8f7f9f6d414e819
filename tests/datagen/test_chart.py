"""The chart: which scene it is of, what is scored, what is written, and what bad input says."""

import csv
import dataclasses
import errno
import json
import math

import numpy as np
import pytest

from datagen.charts import contestants as entrants
from datagen.charts import measure as measuring
from datagen.charts import stability
from datagen.charts.measure import Run, at_error, measure
from datagen.charts.response import of_states, of_trace
from datagen.charts.scenes import find_subject
from datagen.charts.scores import Score, score
from datagen.charts.table import COLUMNS, chart_table
from datagen.cli import app
from datagen.drawing.stability_map import draw_sheet, kind, kinds, stability_sheets
from datagen.drawing.style import house_style, plt
from datagen.drawing.work_precision import (
    RINGED,
    RIVAL_COLOURS,
    RIVAL_STYLES,
    draw_work_precision,
    work_precision_png,
)
from datagen.errors import BadInput
from datagen.files.plain import plain_json
from datagen.runs.progress import steps_told
from physics.integrators.methods import METHODS
from physics.integrators.rivals.general_purpose import (
    BALL_BY_BALL,
    CONTACT_KERNEL,
    PAIRS,
    integrate_by_fixed_steps,
    integrate_compiled,
)
from physics.outcome import Outcome, SimulationFailed
from physics.reference_scenes import REFERENCE_SCENES, reference_scene
from physics.response.stability import longest_stable_step
from physics.simulate import simulate
from physics.statics.load_distribution import equilibrium

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


def test_slip_is_given_after_a_tilde_and_one_percent_is_that_of_the_reference_scenes():
    slipping = find_subject("G1@3~1", 0)
    assert slipping.name == "G1_3x_slip1"
    assert "1 % slip" in slipping.title
    assert slipping.scene == reference_scene("G1", 0.5, slip_seed=1, speed_factor=3.0)
    knots = {percent: find_subject(f"F2~{percent}", 0).scene.cage.knot_values for percent in (0, 1, 4)}
    assert knots[0] == ()
    np.testing.assert_allclose(knots[4], 4.0 * np.array(knots[1]), rtol=0.0, atol=5e-12)  # rounded to 1e-12 each


@pytest.mark.parametrize(("alias", "name"), [("gearbox", "G1"), ("fan", "F1"), ("fan@3~1", "F1@3~1")])
def test_a_rig_by_its_name_is_its_line_spall(alias, name):
    assert find_subject(alias, 0) == find_subject(name, 0)


def test_a_dataset_is_charted_by_its_bare_name_as_other_commands_take_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert find_subject("quickstart", 3).name == "quickstart_3"


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
        (("chart", "G9", "--out", "OUT"), "quickstart"),
        (("chart", "quikstart", "--out", "OUT"), 'did you mean "quickstart"?'),
        (("chart", "G1@fast", "--out", "OUT"), "G1@0.01 to G1@100"),
        (("chart", "fan@", "--out", "OUT"), "fan@0.01 to fan@100"),
        (("chart", "G1~11", "--out", "OUT"), "G1~0 to G1~10"),
        (("chart", "G1~1@3", "--out", "OUT"), "G1@3~1"),
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
def test_fixed_steps_through_changes_of_contact_reach_the_same_response_slowly(kind_of_slope):
    scene = reference_scene("F1", 0.03)
    exact = simulate(scene, RATE, method="exponential_rk4", substeps=16, estimate_error=False)
    start, size = entrants.start_of(scene), np.sqrt(np.mean(exact.acceleration**2))

    def error(substeps):
        states = integrate_by_fixed_steps(scene, kind_of_slope, start, RATE, exact.time.size, substeps)
        return np.sqrt(np.mean((of_states(scene, RATE, states).acceleration - exact.acceleration) ** 2)) / size

    coarse, fine = error(16), error(64)
    # Over a jump of force any method is of order 1: a quarter of the step, a quarter of the error, or a little less.
    assert coarse / 16.0 < fine < coarse / 2.5
    assert fine < 1e-3


def test_every_rival_has_a_colour_and_a_style():
    for one in entrants.contestants(reference_scene("F1", 0.03), quick=False):
        if one.group in (entrants.COMPILED, entrants.SCIPY):
            kind, solver = one.name.split(",")[0].split()
            assert solver in RIVAL_COLOURS
            assert kind in RIVAL_STYLES


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


def test_a_chart_says_on_what_it_was_measured(small_chart):
    assert {"processor", "cores", "physics"} <= set(small_chart.made_with)


def test_what_is_timed_has_been_run_whole_before_unless_that_is_slow(monkeypatch):
    durations = []
    clock = iter([0.0, 0.4, 1.0, 1.1, 2.0, 2.1, 3.0, 3.1])
    monkeypatch.setattr(measuring.time, "process_time", lambda: next(clock))
    one = entrants.Contestant("g", "n", "s", lambda scene, rate: durations.append(scene.duration), lambda *_: None)
    assert measuring._timed(one, reference_scene("F1", 0.5), RATE, rounds=3)[0] == pytest.approx(0.1)
    assert durations == [0.5] * 4  # the first, of 0.4 s, does not count
    clock = iter([0.0, 0.6])
    assert measuring._timed(one, reference_scene("F1", 0.5), RATE, rounds=3)[0] == pytest.approx(0.6)
    assert durations == [0.5] * 5


def test_the_default_has_an_error_of_its_stiffness_and_is_timed_without_keeping_its_state():
    scene = reference_scene("F1", 0.2)
    exact = of_trace(simulate(scene, RATE, method="exponential_rk4", substeps=4, estimate_error=False, keep_state=True))
    chosen = [one for one in entrants.contestants(scene, quick=True) if one.name.startswith("modal")]
    for one in chosen:
        result = one.run(scene, RATE)
        assert one.read(scene, RATE, result).displacement is None
        assert 0.0 < score(scene, RATE, one.response(scene, RATE, result), exact).stiffness < 0.01
    assert chosen


def test_a_scene_that_cannot_be_simulated_ends_with_1_and_one_line(monkeypatch, tmp_path):
    def refuse(*_, **__):
        raise SimulationFailed(Outcome.NO_START, "no position carries the load")

    monkeypatch.setattr(measuring, "simulate", refuse)
    code, _, told = run_command("chart", "F1", "--quick", "--out", tmp_path)
    assert code == 1
    assert "this cannot be simulated: no position carries the load; " in told
    assert "Traceback" not in told
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_is_one_line_that_names_the_folder(monkeypatch, tmp_path, small_chart):
    def full(path, data):
        raise OSError(errno.ENOSPC, "No space left on device", str(path))

    monkeypatch.setattr(measuring, "measure", lambda *_: small_chart)
    monkeypatch.setattr("datagen.files.atomic.write_atomically", full)
    code, _, told = run_command("chart", "F1", "--out", tmp_path)
    assert code == 2
    assert "cannot write here: No space left on device" in told
    assert str(tmp_path) in told
    assert "Traceback" not in told


def test_progress_is_plain_lines_where_it_is_piped(capsys):
    clock = iter([0.0, 1.0, 2.5])
    with steps_told(lambda: next(clock)) as tell:
        for step in ("1 of 3: a", "2 of 3: b", "3 of 3: c"):
            tell(step)
    assert capsys.readouterr().err == "1 of 3: a\n3 of 3: c\n"


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
    for one in maps:
        words, errors = np.array(one["outcomes"]), np.array(one["error"], dtype=object)
        assert np.array_equal(words == "value", errors != None)  # noqa: E711
        ends = {each.name.lower().replace("_", " ") for each in Outcome}
        assert set(words.ravel()) <= {"value", "not converged", *ends}
    assert [row[one_step] for row in fixed["refused"]] == [False, True]
    assert not np.any(chosen["refused"])
    assert (tmp_path / "stability_maps.png").read_bytes().startswith(PNG)


def made_map(sweep):
    """A map of two values: at the first all is accurate, at the second steps end by an outcome or are refused."""
    return stability.Map(
        method="m",
        scale=stability.BY_STEP,
        rows=stability.STEPS,
        sweep=sweep,
        unit="u",
        values=(1.0, 3e4),
        error=((0.0,) * 8, (math.nan,) * 8),
        outcomes=((stability.VALUE,) * 8, ("not finite",) * 8),
        refused=((False,) * 8, (True,) * 2 + (False,) * 6),
        limit=(math.inf, 2.0),
    )


def test_the_kinds_of_a_map_follow_refusal_outcome_and_size_of_the_error():
    value, failed = stability.VALUE, (math.nan, "not finite")
    assert [kind(error, value, False) for error in (5e-4, 5e-3, 5e-2, 0.5)] == [0, 1, 2, 3]
    assert [kind(*failed, False), kind(*failed, True), kind(5e-4, value, True)] == [4, 6, 6]
    assert kind(math.nan, stability.NOT_CONVERGED, True) == 5
    assert kinds(made_map("s")) == [[0, 6]] * 2 + [[0, 4]] * 6


def test_a_step_is_refused_on_the_map_where_simulate_refuses_it():
    soft = stability.SWEEPS[0].apply(reference_scene("G1", 0.01), 1e3)
    limit = stability._limit(soft, "exponential_rk4")
    assert 1.0 / 16.0 < limit < 1.0
    for steps in stability.STEPS_A_SAMPLE:
        try:
            simulate(soft, stability.RATE, method="exponential_rk4", substeps=steps, estimate_error=False)
            outcome = None
        except SimulationFailed as failure:
            outcome = failure.outcome
        assert (outcome is Outcome.UNSTABLE_STEP) == stability._refused(1.0 / steps, limit)


def test_a_sheet_of_maps_holds_four_quantities():
    assert [sheet[:6] for sheet in stability_sheets([made_map(name) for name in "abcde"])] == [PNG] * 2
    with house_style():
        figure = draw_sheet([made_map(name) for name in "abcd"], "1 of 2")
        figure.canvas.draw()
        named = [panel.texts[0].get_text() for panel in figure.axes]
        hatched = [sum(patch.get_hatch() is not None for patch in panel.patches) for panel in figure.axes]
        plt.close(figure)
    assert named == list("abcd")
    assert hatched == [2] * 4


def test_the_default_is_named_in_the_legend_and_small_errors_are_on_the_panel(small_chart):
    tiny = dataclasses.replace(small_chart.runs[0].score, acceleration=3e-8)
    run = dataclasses.replace(small_chart.runs[0], name="modal", score=tiny)
    with house_style():
        figure = draw_work_precision(dataclasses.replace(small_chart, runs=(run,), edges={}))
        panel = figure.axes[1]
        named, low = [text.get_text() for text in panel.get_legend().get_texts()], panel.get_ylim()[0]
        plt.close(figure)
    assert named == ["modal (default)"]
    assert low == pytest.approx(1e-8)


@pytest.mark.parametrize(("error", "edge"), [(12.0, 8.0), (1e-9, 1e-8)])
def test_an_error_beyond_the_panel_is_ringed_on_its_edge_and_one_on_it_is_not(small_chart, error, edge):
    score = small_chart.runs[0].score
    runs = [
        dataclasses.replace(small_chart.runs[0], real_time=speed, score=dataclasses.replace(score, acceleration=value))
        for speed, value in ((3.0, 1e-3), (7.0, error))
    ]
    with house_style():
        drawn = {}
        for kept in (1, 2):
            chart = dataclasses.replace(small_chart, runs=tuple(runs[:kept]), edges={})
            figure = draw_work_precision(chart)
            drawn[kept] = {line.get_label(): line.get_xydata().tolist() for line in figure.axes[1].lines}
            plt.close(figure)
    assert RINGED not in drawn[1]
    assert drawn[2][RINGED] == [[7.0, edge]]
    assert drawn[2][runs[0].name] == [[3.0, 1e-3], [7.0, edge]]


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


def test_an_edge_is_the_speed_at_the_longest_stable_step_however_fine_the_run_it_is_told_from():
    scene, name = reference_scene("F1", 0.1), "runge_kutta4"
    # A step of one sample at ten times real time, or of a quarter of it at 2.5 times: the same cost a step.
    runs = [Run("method", name, f"{steps} steps", 0.1, 0.01 * steps, 10.0 / steps, None, "") for steps in (1, 4)]
    one, four = (measuring._edges(scene, RATE, [run])[name] for run in runs)
    assert one == pytest.approx(four, rel=1e-12)
    rest = equilibrium(scene, np.zeros(1))
    longest = longest_stable_step(scene.rig, METHODS[name], rest.stiffness[0], rest.damping[0])
    assert one == pytest.approx(10.0 * longest / (1.0 / RATE), rel=1e-12)

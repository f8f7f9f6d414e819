"""A record whose bouncing balls leave no trajectory to converge to says so."""

from dataclasses import replace

import pytest

from datagen.recipes.recipe import load_recipe
from datagen.records.record import make_record
from datagen.scenarios.sampling import draw_scenario
from labels.description import label_values
from physics.request import FixedSteps
from physics.response.adaptive import respond_accurately
from physics.response.asked import Asked
from physics.response.oversampling import oversampling
from physics.rms import rms
from physics.simulate import simulate
from physics.statics.load_distribution import resting

LOOSE_RECORD = 110  # of the wide corpus: a change of contact every 7 ms and ball


@pytest.fixture(scope="module")
def scenario():
    drawn = draw_scenario(load_recipe("corpus"), LOOSE_RECORD)
    cages = [cage and replace(cage, duration=0.2) for cage in (drawn.scene.cage, drawn.scene.second_cage)]
    return replace(drawn, scene=replace(drawn.scene, cage=cages[0], second_cage=cages[1]))


def test_two_step_sizes_of_another_method_end_far_apart(scenario):
    one, other = (simulate(scenario.scene, scenario.rate, FixedSteps(count)).acceleration for count in (16, 32))
    assert ((one - other) ** 2).mean() > 0.01 * (other**2).mean()  # a hundred times the accuracy asked for


def test_the_record_is_called_chaotic_and_its_points_unknown(scenario):
    record = make_record(scenario)
    assert "chaotic" in record.labels["validity"]
    assert "accuracy" not in record.labels["validity"]
    assert record.labels["validity"].startswith(label_values(scenario.scene)["validity"])
    assert record.labels["error_estimate"] == 1.0


def test_chaos_that_begins_after_the_pilots_is_seen_by_a_finer_response():
    late = draw_scenario(load_recipe("corpus").model_copy(update={"seed": 20261201}), 5900)
    trace = simulate(late.scene, late.rate)
    one, other = (simulate(late.scene, late.rate, FixedSteps(count)).acceleration for count in (16, 64))
    assert ((one - other) ** 2).mean() > 0.01 * (other**2).mean()
    assert trace.chaotic
    assert trace.error_estimate == 1.0


def respond(record):
    """The trace of a record of the wide corpus, and how many responses were made after the first."""
    drawn, made = draw_scenario(load_recipe("corpus"), record), []

    def counted(march, grid):
        made.append(march)
        return march.go_on(grid)

    scene, factor = drawn.scene, oversampling(drawn.scene, drawn.rate)
    rate, samples = drawn.rate * factor, drawn.samples * factor
    return respond_accurately(Asked(scene, resting(scene), rate, samples, 1e-3), go_on=counted), len(made)


@pytest.mark.parametrize(
    ("record", "confirmations", "chaotic"),
    [(110, 0, True), (291, 1, True), (289, 2, False)],
    ids=["parted in the first tenth", "parted in the first third", "parted near the middle, and confirmed at last"],
)
def test_a_response_is_confirmed_as_often_as_that_can_help(record, confirmations, chaotic):
    trace, made = respond(record)
    assert trace.chaotic is chaotic
    assert made == 1 + confirmations  # a finer one before them


def test_a_response_is_not_confirmed_after_one_that_took_too_many_steps(monkeypatch):
    monkeypatch.setattr("physics.response.attempts.MUCH_WORK", 1)
    trace, made = respond(289)
    assert made == 2  # one fewer than above
    assert not trace.chaotic
    assert trace.error_estimate > 1e-3  # and the record says that it may be so far off


def test_an_accuracy_that_was_not_reached_is_told(scenario, monkeypatch):
    tame = draw_scenario(load_recipe("gearbox_rig"), 0)

    def missed(*scene, **choices):
        return replace(simulate(*scene, **choices), error_estimate=0.02)

    monkeypatch.setattr("datagen.records.record.simulate", missed)
    validity = make_record(tame).labels["validity"]
    assert "the accuracy asked for, 0.001, was not reached: it may be 0.02 off" in validity
    assert "chaotic" not in validity


@pytest.mark.parametrize(("sensitivity", "told"), [(400.0, True), (4.0, False), (float("nan"), False)])
def test_a_response_that_multiplies_errors_without_being_chaotic_is_told(sensitivity, told, monkeypatch):
    def sensitive(*scene, **choices):
        return replace(simulate(*scene, **choices), sensitivity=sensitivity)

    monkeypatch.setattr("datagen.records.record.simulate", sensitive)
    validity = make_record(draw_scenario(load_recipe("gearbox_rig"), 0)).labels["validity"]
    assert ("contacts multiply errors 400 times" in validity) is told


QUIET_RECORDS = (8, 52)  # of the wide corpus: healthy, noise far above the vibration, so that large errors are allowed


@pytest.mark.parametrize("record", QUIET_RECORDS)
def test_a_quiet_record_whose_noise_allows_a_large_error_is_not_called_chaotic(record):
    made = make_record(draw_scenario(load_recipe("corpus"), record))
    assert made.labels["error_estimate"] > 1.0
    assert "chaotic" not in made.labels["validity"]


def test_a_tame_record_is_not(scenario):
    tame = draw_scenario(load_recipe("gearbox_rig"), 0)
    assert "chaotic" not in make_record(tame).labels["validity"]


def test_changes_of_contact_that_could_not_be_located_are_told(scenario, monkeypatch):
    def unlocated(*scene, **choices):
        return replace(simulate(*scene, **choices), unlocated_changes=3)

    monkeypatch.setattr("datagen.records.record.simulate", unlocated)
    assert "3 changes of contact could not be located" in make_record(scenario).labels["validity"]


def test_an_error_below_what_noise_hides_is_no_missed_accuracy(monkeypatch):
    tame = draw_scenario(load_recipe("gearbox_rig"), 0)
    level = rms(simulate(tame.scene, tame.rate).acceleration)
    monkeypatch.setattr(
        "datagen.records.record.simulate",
        lambda *scene, **choices: replace(simulate(*scene, **choices), error_estimate=0.02),
    )
    for hidden, warned in ((0.03, False), (0.01, True), (0.0, True)):
        monkeypatch.setattr(
            "datagen.records.response_warnings.allowed_error", lambda _, least=hidden * level: (1e-3, least)
        )
        assert ("was not reached: it may be 0.02 off" in make_record(tame).labels["validity"]) is warned

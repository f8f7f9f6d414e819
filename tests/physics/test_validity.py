import dataclasses
import math

import numpy as np
import pytest
from scipy.optimize import fsolve

from labels.description import label_values
from physics.cage import CagePath
from physics.catalog import rig
from physics.imperfections import Imperfections
from physics.operation import Operation
from physics.outcome import StaticOutcome
from physics.rating import static_load_rating
from physics.scene import Scene
from physics.spall import Spall
from physics.statics.load_distribution import equilibrium
from physics.validity import assess, centrifugal_force, element_mass, inertia_force, peak_ball_load

DOWN = math.radians(270)
RPM = 2 * math.pi / 60


def scene_of(machine, spalls=(), speed=None, load=None):
    speed = machine.rated_speed if speed is None else speed
    load = machine.rated_load if load is None else load
    cage = CagePath(nominal_speed=machine.bearing.cage_speed(speed), duration=0.5)
    return Scene(rig=machine, operation=Operation(shaft_speed=speed, load=load), cage=cage, spalls=spalls)


def peak_by_search(machine, load):
    """Largest ball load (N) of all cage angles within a spacing, from the balance of forces [P14 Eq. 18-22]."""
    bearing = machine.bearing
    spread = bearing.spacing * np.arange(bearing.balls)
    offsets = np.concatenate([spread, spread + bearing.stagger])[: bearing.rows * bearing.balls]

    def forces(place, angles):
        compression = place[0] * np.cos(angles) + place[1] * np.sin(angles) - bearing.clearance
        return bearing.load_deflection * np.maximum(compression, 0.0) ** bearing.exponent

    def unbalanced(place_um, angles):
        force = forces(1e-6 * place_um, angles)
        return [force @ np.cos(angles), force @ np.sin(angles) + load]

    peaks = []
    for turned in np.linspace(0.0, bearing.spacing, 97):
        place = fsolve(unbalanced, np.array([0.0, -6.0 - 1e6 * bearing.clearance]), args=(turned + offsets,))
        peaks.append(forces(1e-6 * place, turned + offsets).max())
    return max(peaks)


def line(extent_deg, entry=0.3, exit=0.3, **other):
    extent = math.radians(extent_deg)
    return Spall("outer", 1, DOWN, extent, 12e-6, math.radians(entry), math.radians(exit), **other)


def test_a_steel_ball_of_7_12_mm_weighs_1_48_grams(gearbox):
    by_hand = 7850 * math.pi / 6 * 0.00712**3
    assert element_mass(gearbox.bearing) == pytest.approx(by_hand, rel=1e-12)
    assert by_hand == pytest.approx(1.48e-3, rel=5e-3)  # three digits


def test_a_roller_weighs_as_much_as_the_cylinder_that_its_factor_stands_for():
    roller = rig("ims").bearing
    by_hand = 7850 * math.pi / 4 * 8.407e-3**2 * 11e-3
    assert element_mass(roller) == pytest.approx(by_hand, rel=1e-9)  # rounding of powers


def test_the_centrifugal_force_of_a_gearbox_ball_is_9_millinewton(gearbox):
    # m = 1.4836 g, radius 19.375 mm, cage 0.5 · 2π7 · (1 − 7.12/38.75) = 17.951 rad/s
    assert centrifugal_force(scene_of(gearbox)) == pytest.approx(1.4836e-3 * 19.375e-3 * 17.951**2, rel=2e-4)  # digits


def test_the_balls_turn_as_fast_as_their_cage_says_and_not_as_the_shaft_does(gearbox):
    scene, quick = scene_of(gearbox, (line(2.0),)), CagePath(3.0 * 17.951, 0.5)
    for dragged in (dataclasses.replace(scene, cage=quick), dataclasses.replace(scene, second_cage=quick)):
        assert centrifugal_force(dragged) == pytest.approx(9.0 * centrifugal_force(scene), rel=2e-4)  # digits
    dragged = dataclasses.replace(scene, cage=quick)
    outer, inner = scene.spalls[0], dataclasses.replace(scene.spalls[0], race="inner")
    assert inertia_force(dragged, outer) == pytest.approx(9.0 * inertia_force(scene, outer), rel=2e-4)
    ratio = (3.0 * 17.951 - 43.982) / (43.982 - 17.951)  # against the shaft
    assert inertia_force(dragged, inner) == pytest.approx(ratio**2 * inertia_force(scene, inner), rel=1e-3)


@pytest.mark.parametrize(("race", "share"), [("outer", 0.9), ("inner", (43.982 - 0.9 * 17.951) / (43.982 - 17.951))])
def test_balls_of_a_slipping_cage_pass_an_outer_spall_slower_and_an_inner_one_faster(gearbox, race, share):
    spall = dataclasses.replace(line(1.3), race=race)
    rolling = scene_of(gearbox, (spall,))
    slipping = dataclasses.replace(rolling, cage=dataclasses.replace(rolling.cage, mean_slip=0.1))
    assert inertia_force(slipping, spall) == pytest.approx(share**2 * inertia_force(rolling, spall), rel=1e-4)


@pytest.mark.parametrize("cage", ["cage", "second_cage"])
def test_a_cage_that_does_not_fit_the_shaft_is_told(gearbox, cage):
    scene = scene_of(gearbox)
    faster = dataclasses.replace(scene, operation=Operation(2.0 * gearbox.rated_speed, gearbox.rated_load))
    message = "the cage turns at a nominal 17.95 rad/s, but without slip the shaft would turn it at 35.9 rad/s"
    assert [note.split(":")[0] for note in assess(faster)] == [message]
    slow = dataclasses.replace(scene, **{cage: CagePath(9.0, 0.5)})
    assert any("the cage turns at a nominal 9 rad/s" in note for note in assess(slow))
    # Speeds of seven digits are those of pure rolling.
    for off, noted in ((5e-7, 0), (-5e-7, 0), (5e-6, 1), (-5e-6, 1)):
        nearly = CagePath(scene.cage.nominal_speed * (1.0 + off), 0.5)
        assert len(assess(dataclasses.replace(scene, **{cage: nearly}))) == noted
    slipping = dataclasses.replace(scene, cage=dataclasses.replace(scene.cage, mean_slip=0.1))
    assert assess(slipping) == ()


def test_the_inertia_over_a_taper_is_twice_mass_times_drop_over_time_squared(fan):
    spall = line(2.6)
    # 0.3° at the cage speed of 34.44 rad/s takes 0.1520 ms; 12 µm in that time is 1038 m/s²; the ball weighs 2.104 g.
    force = inertia_force(scene_of(fan, (spall,)), spall)
    assert force == pytest.approx(2.1044e-3 * 2 * 12e-6 / (math.radians(0.3) / 34.441) ** 2, rel=2e-4)  # digits


def test_the_sharper_edge_counts(fan):
    both, exit_only = line(2.6), line(2.6, entry=2.0)
    assert inertia_force(scene_of(fan, (both,)), both) == pytest.approx(
        inertia_force(scene_of(fan, (exit_only,)), exit_only), rel=1e-12
    )


def test_an_inner_race_passes_faster_below_a_ball_than_the_outer_one(fan):
    outer, inner = line(2.6), dataclasses.replace(line(2.6), race="inner")
    ratio = inertia_force(scene_of(fan, (inner,)), inner) / inertia_force(scene_of(fan, (outer,)), outer)
    ftf = fan.bearing.ftf
    assert ratio == pytest.approx(((1 - ftf) / ftf) ** 2, rel=1e-12)


def test_a_ball_hanging_on_the_edges_of_a_deep_gap_falls_over_half_of_it(authority, gearbox):
    gap = dataclasses.replace(line(2.0, 0.0, 0.0), depth=3e-4, profile="ball_path")
    scene = scene_of(gearbox, (gap,))
    fall = math.radians(1.0) / scene.cage.nominal_speed
    drop = authority("independent_model")["ball_path"]["gearbox_outer_2_deg_um"]["value"] * 1e-6
    by_hand = element_mass(gearbox.bearing) * 2 * drop / fall**2
    assert inertia_force(scene, gap) == pytest.approx(by_hand, rel=0.01)  # the drop is given to three digits


def test_over_a_rough_floor_the_steepest_way_between_crest_and_trough_counts(fan):
    waves, amplitude = 20, 1.5e-6
    values = amplitude * (1.0 - np.cos(np.linspace(0.0, 2.0 * math.pi * waves, 40 * waves + 1)))
    smooth = Spall("outer", 1, DOWN, 0.2, 0.4e-6, 0.05, 0.05)
    rough = dataclasses.replace(smooth, roughness=amplitude, roughness_values=tuple(values))
    scene = scene_of(fan, (rough,))
    half_wave = 0.2 / waves / 2.0 / scene.cage.nominal_speed
    by_hand = element_mass(fan.bearing) * 2 * 2 * amplitude / half_wave**2
    assert inertia_force(scene, rough) == pytest.approx(by_hand, rel=0.05)  # down the entry taper it is a little more
    assert inertia_force(scene, smooth) < 0.1 * by_hand


def test_of_thousands_of_roughness_values_no_crest_is_missed(fan):
    waves, amplitude = 370, 0.1e-6
    values = amplitude * (1.0 - np.cos(np.linspace(0.0, 2.0 * math.pi * waves, 8 * waves + 1)))
    values[[0, -1]] = 0.0
    rough = Spall("outer", 1, DOWN, 0.2, 0.0, roughness=amplitude, roughness_values=tuple(values))
    scene = scene_of(fan, (rough,))
    half_wave = 0.2 / waves / 2.0 / scene.cage.nominal_speed
    by_hand = element_mass(fan.bearing) * 2 * 2 * amplitude / half_wave**2
    assert inertia_force(scene, rough) == pytest.approx(by_hand, rel=0.1)  # 32 samples of half a wave, give or take 1


def test_a_ball_of_a_cage_of_its_own_runs_over_a_spall_as_fast_as_that(gearbox):
    first, second = (dataclasses.replace(line(2.0), row=row) for row in (1, 2))
    scene = dataclasses.replace(scene_of(gearbox), second_cage=CagePath(2.0 * 17.951, 0.5))
    ratio = inertia_force(scene, second) / inertia_force(scene, first)
    assert ratio == pytest.approx(4.0, rel=2e-4)  # digits


def measured(extent, angle, depth):
    return Spall("outer", 1, DOWN, extent, 0.0, profile="table", table_angle=angle, table_depth=depth)


def test_of_thousands_of_points_of_a_table_no_crest_is_missed(gearbox):
    waves, amplitude = 3000, 1e-9  # so low that the ball follows them
    angle = np.linspace(-1.2, 1.2, 4 * waves + 1)
    rough = measured(2.4, angle, amplitude * (1.0 - np.cos(math.pi / 2.0 * np.arange(angle.size))))
    scene = scene_of(gearbox, (rough,))
    half_wave = 2.4 / waves / 2.0 / scene.cage.nominal_speed
    by_hand = element_mass(gearbox.bearing) * 2 * 2 * amplitude / half_wave**2
    assert inertia_force(scene, rough) == pytest.approx(by_hand, rel=0.1)  # 32 samples of a wave, give or take 1


@pytest.mark.parametrize(
    ("foot", "pit", "end"), [(0.01, 0.0, 0.0), (0.01, 1e-6, 1e-6), (0.0, 40e-6, 0.0)], ids=["flat", "shallow", "deep"]
)
def test_a_ball_that_climbs_a_proud_bump_takes_the_force_of_its_way_up(fan, foot, pit, end):
    # A plateau with a cliff, and perhaps a shallow pit behind it, or a deep one with long slopes: the ball
    # touches the corner of the cliff where its centre is off by the arc at which it hangs as far below the plateau as
    # that stands above the race.
    height, half = 20e-6, 0.05
    bump = measured(2.0 * half, (-half, -0.03 if end < pit else -0.01, foot, half), (-height, -height, pit, end))
    scene = scene_of(fan, (bump,))
    top, ball = fan.bearing.raceway_radius("outer") - height, fan.bearing.ball_radius
    # The law of cosines: corner, centre of the ball before it climbs, axis of the bearing.
    centre = fan.bearing.raceway_radius("outer") - ball
    arc = math.acos((top**2 + centre**2 - ball**2) / (2.0 * top * centre))
    arc *= 1.0 - math.sqrt(1e-3)  # the last thousandth of the height does not count, and heights are nearly parabolas
    by_hand = element_mass(fan.bearing) * 2 * height * (scene.cage.nominal_speed / arc) ** 2
    assert inertia_force(scene, bump) == pytest.approx(by_hand, rel=5e-3)  # 4000 samples over it all
    assert assess(scene) == ()


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_a_bump_without_any_pit_can_be_judged_and_a_flat_table_asks_for_no_force(gearbox, race):
    bump = measured(0.035, (-0.017, -0.01, 0.01, 0.017), (0.0, -1e-5, -1e-5, 0.0))
    flat = measured(0.035, (-0.017, 0.017), (0.0, 0.0))
    bump, flat = (dataclasses.replace(spall, race=race) for spall in (bump, flat))
    assert inertia_force(scene_of(gearbox, (bump,)), bump) > 0.0
    assert inertia_force(scene_of(gearbox, (flat,)), flat) == 0.0
    assert assess(scene_of(gearbox, (flat,))) == ()


@pytest.mark.parametrize("name", ["gearbox", "fan"])
def test_the_paper_s_rigs_at_their_own_operating_points_are_in_range(request, name):
    machine = request.getfixturevalue(name)
    extent = {"gearbox": 2.0, "fan": 2.6}[name]
    gradual = line(extent, entry=0.9 * extent, exit=0.1 * extent)
    deep = dataclasses.replace(line(extent, 0.0, 0.0), depth=3e-4, profile="ball_path")
    wide = dataclasses.replace(line(40.0, 1.0, 1.0), depth=4e-6)
    for spalls in ((), (line(extent),), (gradual,), (deep,), (wide,)):
        assert assess(scene_of(machine, spalls)) == ()


def test_fast_running_brings_ball_inertia_and_centrifugal_force_into_the_note(fan):
    notes = assess(scene_of(fan, (line(2.6),), speed=8000 * RPM))
    peak = peak_by_search(fan, 100.0)
    assert peak == pytest.approx(23.28, abs=0.05)  # three digits, as shown; 15.6 N if there were no clearance
    assert notes[0] == (
        "the centrifugal force of a ball (5.62 N) is left out but is 0.24 times the peak ball load (23.3 N)"
    )
    assert notes[1].startswith(
        "the inertia of a ball on its way over the spall (219 N, 2 m h / t^2 of the steepest drop h"
    )
    assert "is left out but is 9.4 times" in notes[1]
    assert len(notes) == 2


def test_the_note_appears_where_the_force_passes_a_fifth_of_the_peak_load(fan):
    spall = line(2.6)
    rated = inertia_force(scene_of(fan, (spall,)), spall)
    limit = math.sqrt(0.2 * peak_by_search(fan, 100.0) / rated) * fan.rated_speed
    assert assess(scene_of(fan, (spall,), speed=0.999 * limit)) == ()
    assert len(assess(scene_of(fan, (spall,), speed=1.001 * limit))) == 1


def test_the_note_on_the_centrifugal_force_appears_where_it_passes_a_fifth_of_the_peak_load(fan):
    rated = element_mass(fan.bearing) * 22.5e-3 * fan.bearing.cage_speed(fan.rated_speed) ** 2
    limit = math.sqrt(0.2 * peak_by_search(fan, 100.0) / rated) * fan.rated_speed
    assert assess(scene_of(fan, speed=0.999 * limit)) == ()
    [note] = assess(scene_of(fan, speed=1.001 * limit))
    assert note.startswith("the centrifugal force of a ball")


def test_the_peak_load_of_a_load_that_swings_is_that_of_its_largest(fan):
    swinging = dataclasses.replace(scene_of(fan).operation, load_fluctuation=1.0, fluctuation_phase=2.0)
    peak = peak_ball_load(dataclasses.replace(scene_of(fan), operation=swinging))
    assert peak == pytest.approx(peak_by_search(fan, 200.0), rel=3e-3)  # 256 instants, none of them at the very peak


def test_the_worst_of_several_spalls_is_named(fan):
    mild = dataclasses.replace(line(2.6), depth=1e-6)
    harsh = dataclasses.replace(line(2.6, exit=0.1), angle=math.radians(90))
    assert assess(scene_of(fan, (mild, harsh))) == assess(scene_of(fan, (harsh, mild))) != ()


def test_an_edge_without_taper_is_out_of_range(gearbox):
    inertia, film = assess(scene_of(gearbox, (line(2.0, 0.0, 0.0),)))
    assert "inertia of a ball" in inertia
    # 100 N s/m of the gearbox rig times 12 µm
    assert film.startswith("an edge without taper is a step that the film does not feel")
    assert "an impulse of 0.0012 N s (radial damping times depth)" in film
    shallow, one_edge = dataclasses.replace(line(2.0, 0.0, 0.0), depth=3e-6), line(2.0, 0.0, 0.3)
    for spalls in ((one_edge,), (line(2.0, 0.3, 0.0),), (dataclasses.replace(shallow, angle=1.0), one_edge)):
        assert any("an impulse of 0.0012 N s" in note for note in assess(scene_of(gearbox, spalls)))
    steep = dataclasses.replace(gearbox.bearing, contact_angle=math.radians(40))
    inclined = dataclasses.replace(gearbox, bearing=steep)
    assert any("impulse of 0.000704 N s" in note for note in assess(scene_of(inclined, spalls)))  # times cos²(40°)
    dry = dataclasses.replace(gearbox, film_damping=0.0)
    assert not [note for note in assess(scene_of(dry, (line(2.0, 0.0, 0.3),))) if "film" in note]
    gap = dataclasses.replace(line(2.0, 0.0, 0.0), depth=3e-4, profile="ball_path")
    assert not [note for note in assess(scene_of(gearbox, (gap,))) if "film" in note]


def test_the_label_can_be_parted_into_its_notes_again(gearbox):
    steep = dataclasses.replace(gearbox.bearing, contact_angle=math.radians(40))
    scene = scene_of(dataclasses.replace(gearbox, bearing=steep), (line(2.0, 0.0, 0.0),), speed=20000 * RPM)
    notes = assess(scene)
    assert len(notes) >= 4
    assert tuple(label_values(scene)["validity"].split("; ")) == notes


def test_a_bearing_turned_faster_than_grease_allows_is_noted(gearbox):
    (note,) = [n for n in assess(scene_of(gearbox, speed=20000 * RPM)) if "pitch diameter" in n]
    assert note.startswith("shaft speed times pitch diameter is 7.75e+05 rpm mm, above the 5e+05 rpm mm usual")


@pytest.mark.parametrize("share", [0.999, 1.001])
def test_the_note_on_grease_appears_where_speed_times_pitch_diameter_passes_half_a_million(gearbox, share):
    scene = scene_of(gearbox, speed=share * 5e5 / 38.75 * RPM)  # of a pitch diameter of 38.75 mm
    assert any("pitch diameter" in note for note in assess(scene)) == (share > 1.0)


def test_without_load_a_force_is_told_beside_none(gearbox):
    [note] = [note for note in assess(scene_of(gearbox, load=0.0)) if note.startswith("the centrifugal force")]
    assert note.endswith("is left out but is not small beside the peak ball load (0 N)")


@pytest.mark.parametrize("share", [0.99, 1.01])
def test_the_note_on_dents_appears_where_a_preload_passes_the_peak_at_the_static_rating(gearbox, share):
    # The most loaded of Z balls carries 4.37/Z of the rating, which is 14.7 N/mm² · Z · (7.12 mm)².
    preload = share * 4.37 * 14.7 * 7.12**2
    tight = with_clearance(gearbox, -((preload / gearbox.bearing.load_deflection) ** (2.0 / 3.0)))
    assert any("dented" in note for note in assess(scene_of(tight, load=0.0))) == (share > 1.0)


def test_no_load_and_reversed_load_are_noted_with_their_numbers(gearbox):
    none = assess(scene_of(gearbox, load=0.0))
    assert any(note.startswith("there is no load (0 N)") for note in none)
    (reversed_load,) = assess(scene_of(gearbox, load=-346.0))
    assert reversed_load.startswith("the static load is reversed (-346 N): the load zone is centred at 90 degrees")


def test_a_load_above_the_static_rating_is_noted_with_both(gearbox):
    [note] = assess(scene_of(gearbox, load=22e3))
    # ISO 76 with one factor: 14.7 N/mm² · 2 rows · 12 balls · (7.12 mm)² = 17.9 kN
    message = "the load on the shaft (2.2e+04 N at its largest) exceeds the static rating of the bearing (1.788e+04 N)"
    assert note.startswith(message)


def with_clearance(machine, clearance):
    return dataclasses.replace(machine, bearing=dataclasses.replace(machine.bearing, clearance=clearance))


def test_a_reversed_load_is_noted_beside_one_that_is_too_large(gearbox):
    rating = static_load_rating(gearbox.bearing)
    first, second = (
        note for note in assess(scene_of(gearbox, load=-1.1 * rating)) if "static load is" in note or "rating" in note
    )
    assert "exceeds the static rating" in first
    assert second.startswith("the static load is reversed")


@pytest.mark.parametrize("load", [0.0, 346.0])
def test_a_load_that_turns_with_the_shaft_counts(gearbox, load):
    run = dataclasses.replace(scene_of(gearbox).operation, load=load, unbalance_force=1e5, load_fluctuation=3.0)
    [note] = [note for note in assess(dataclasses.replace(scene_of(gearbox), operation=run)) if "static rating" in note]
    # Both phases are 0: the load is (U cos θ, U sin θ − W (1 + 3 cos θ)), here searched for its largest magnitude.
    angle = np.linspace(0.0, 2.0 * math.pi, 100_001)
    magnitude = np.hypot(1e5 * np.cos(angle), 1e5 * np.sin(angle) - load * (1.0 + 3.0 * np.cos(angle)))
    assert note.startswith(f"the load on the shaft ({magnitude.max():.4g} N at its largest) exceeds")


def test_a_preloaded_bearing_without_static_load_has_a_quasi_static_position(gearbox):
    # No load at all: every ball is compressed by 10 µm, K δ^1.5 each.
    still = scene_of(with_clearance(gearbox, -1e-5), load=0.0)
    each = gearbox.bearing.load_deflection * 1e-5**1.5
    assert peak_ball_load(still) == pytest.approx(each, rel=1e-9)  # rounding
    assert assess(still) == ()
    turning = dataclasses.replace(still.operation, unbalance_force=20.0)
    assert assess(dataclasses.replace(still, operation=turning)) == ()


def test_a_preload_or_an_oversized_ball_that_dents_the_races_is_noted(gearbox):
    crushed = scene_of(with_clearance(gearbox, -1e-3))
    balls = ((1e-3, *(0.0,) * 11), (0.0,) * 12)
    wedged = dataclasses.replace(scene_of(gearbox), imperfections=Imperfections(ball_deviation=balls))
    for scene in (crushed, wedged):
        [note] = [note for note in assess(scene) if "dented" in note]
        # At the rating, 17.88 kN, the most loaded of 24 balls carries 4.37 / 24 of it.
        assert note.startswith("the most loaded ball carries 1")
        assert "more than at the static rating of the bearing (3257 N)" in note
    assert gearbox.bearing.load_deflection * 1e-3**1.5 == pytest.approx(1.6e5, rel=0.03)  # of 1 mm alone


def test_where_no_position_carries_the_load_no_ball_has_one(gearbox):
    soft = dataclasses.replace(gearbox.bearing, load_deflection=1e3, clearance=-1e-3)
    scene = scene_of(dataclasses.replace(gearbox, bearing=soft))
    # 346 N would take half a metre; in the middle the preload alone would press each ball with 0.03 N.
    assert equilibrium(scene, np.zeros(1)).outcome(0) is StaticOutcome.NO_EQUILIBRIUM
    assert peak_ball_load(scene) == 0.0


def test_a_contact_angle_is_noted_with_its_cosine():
    (note,) = assess(scene_of(rig("ims")))
    assert note.startswith("the contact angle of 15.17 degrees enters only as a factor 0.9652 on deflection and force")


def test_a_contact_angle_is_noted_where_a_fifth_of_the_force_on_a_ball_is_axial(gearbox):
    for share, notes in ((0.0, 0), (0.199, 0), (0.201, 1)):
        bearing = dataclasses.replace(gearbox.bearing, contact_angle=math.asin(share))
        assert len(assess(scene_of(dataclasses.replace(gearbox, bearing=bearing)))) == notes

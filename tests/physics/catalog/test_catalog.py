import math

import pytest

from physics.bearing import Bearing
from physics.catalog import BEARINGS, RIGS, bearing, catalog_rows, rig
from physics.catalog.sourced import Claim, sourced_fields
from physics.checks import InvalidParameter
from physics.hertz import load_deflection_factor, roller_load_deflection_factor
from physics.modes import modes, rated_matrices
from physics.rig import Rig

EXACT = 1e-12  # a change of unit, no more


@pytest.fixture(scope="module")
def rows():
    return catalog_rows()


def test_every_name_of_the_catalogue_builds():
    assert all(isinstance(bearing(name), Bearing) and bearing(name).name == name for name in BEARINGS)
    assert all(isinstance(rig(name), Rig) and rig(name).name == name for name in RIGS)
    assert {"gearbox", "fan", "cwru", "mfpt", "ims"} == set(RIGS)


@pytest.mark.parametrize(
    ("name", "section", "operation", "table", "unit"),
    [
        ("gearbox", "gearbox_bearing", "gearbox_operation", "gearbox_table_1", ("K_MN_per_m15", 1e6)),
        ("fan", "fan_bearing", "fan_operation", "fan_table_2", ("K_GN_per_m15", 1e9)),
    ],
)
def test_the_paper_s_rigs_carry_exactly_the_numbers_of_its_tables(authority, name, section, operation, table, unit):
    paper, machine = authority("petersen_2014"), rig(name)
    ring, run, printed = machine.bearing, paper[operation], paper[table]
    speed = run["speed_hz"] if "speed_hz" in run else run["speed_rpm"] / 60
    pairs = [
        (ring.balls, paper[section]["balls"]),
        (ring.rows, paper[section]["rows"]),
        (ring.pitch_diameter, paper[section]["pitch_diameter_mm"] * 1e-3),
        (ring.ball_diameter, paper[section]["ball_diameter_mm"] * 1e-3),
        (ring.load_deflection, printed[unit[0]] * unit[1]),
        (machine.rated_speed, 2 * math.pi * speed),
        (machine.rated_load, run["load_n"]),
        (machine.film_damping, printed["c_film"]),
        (machine.inner_mass, printed["m_i"]),
        (machine.outer_mass, printed["m_o"]),
        (machine.resonator_mass, printed["m_r"]),
        (machine.support_stiffness_x, printed["k_o_MN_per_m"] * 1e6),
        (machine.support_stiffness_y, printed["k_o_MN_per_m"] * 1e6),
        (machine.resonator_stiffness, printed["k_r_MN_per_m"] * 1e6),
        (machine.support_damping_x, printed["c_o"]),
        (machine.support_damping_y, printed["c_o"]),
        (machine.resonator_damping, printed["c_r"]),
    ]
    for ours, theirs in pairs:
        assert ours == pytest.approx(theirs, rel=EXACT)
    assert ring.clearance == pytest.approx(run["clearance_um"] * 1e-6, rel=EXACT)
    assert ring.contact_angle == paper[section]["contact_angle_deg"] == 0.0
    assert ring.exponent == 1.5
    assert ring.stagger == pytest.approx(ring.spacing / 2, rel=EXACT)


def test_the_bpfo_of_the_gearbox_rig_is_34_283_hz_and_not_the_printed_34_2(authority, gearbox):
    computed = gearbox.bearing.bpfo * gearbox.rated_speed / (2 * math.pi)
    ours, printed = authority("independent_model")["kinematics"], authority("petersen_2014")["contradicted"]
    check = ours["gearbox_bpfo_hz"]
    assert computed == pytest.approx(check["value"], abs=check["tolerance"])  # digits given
    check = ours["gearbox_sixth_harmonic_hz"]
    assert 6 * computed == pytest.approx(check["value"], abs=check["tolerance"])  # digits given
    check = printed["gearbox_bpfo_hz"]
    assert abs(computed - check["value"]) > check["tolerance"]


def test_the_bpfo_of_the_fan_rig_is_76_74_hz(authority, fan):
    computed = fan.bearing.bpfo * fan.rated_speed / (2 * math.pi)
    check = authority("independent_model")["kinematics"]["fan_bpfo_hz"]
    assert computed == pytest.approx(check["value"], abs=check["tolerance"])  # digits given
    check = authority("petersen_2014")["printed"]["fan_bpfo_hz"]
    assert computed == pytest.approx(check["value"], abs=check["tolerance"])  # digits printed


@pytest.mark.parametrize("name", ["skf_6205", "skf_6203", "ldk_uer204", "nice_mfpt", "rexnord_za2115"])
def test_the_published_geometries_give_their_published_ball_pass_frequencies(authority, name):
    published, ring = authority("published_geometry")[name], bearing(name)
    assert (ring.balls, ring.rows) == (published["balls"], published["rows"])
    assert ring.pitch_diameter == pytest.approx(published["pitch_diameter_mm"] * 1e-3, rel=EXACT)
    assert ring.ball_diameter == pytest.approx(published["ball_diameter_mm"] * 1e-3, rel=EXACT)
    assert ring.contact_angle == pytest.approx(math.radians(published["contact_angle_deg"]), rel=EXACT)
    for quantity in ("bpfo", "bpfi"):
        order = getattr(ring, quantity)
        if f"{quantity}_hz" in published:
            check, value = published[f"{quantity}_hz"], order * published["speed_rpm"] / 60
        else:
            check, value = published[f"{quantity}_orders"], order
        assert value == pytest.approx(check["value"], abs=check["tolerance"])  # digits printed


@pytest.mark.parametrize(("name", "entry"), [("cwru", "skf_6205"), ("mfpt", "nice_mfpt"), ("ims", "rexnord_za2115")])
def test_the_other_rigs_run_at_their_published_speed_and_load(authority, name, entry):
    published, machine = authority("published_geometry")[entry], rig(name)
    assert machine.bearing == bearing(entry)
    assert machine.rated_speed == pytest.approx(published["speed_rpm"] * 2 * math.pi / 60, rel=EXACT)
    if "load_lbf" in published:
        assert machine.rated_load == pytest.approx(published["load_lbf"] * 4.4482216152605, rel=EXACT)


def test_factors_without_a_source_come_from_geometry_and_say_that_they_are_assumed():
    for name in ("skf_6205", "skf_6203", "ldk_uer204", "nice_mfpt"):
        ring = bearing(name)
        assert ring.load_deflection == load_deflection_factor(ring.pitch_diameter, ring.ball_diameter)
        assert BEARINGS[name].load_deflection.assumed
    roller = bearing("rexnord_za2115")
    assert roller.exponent == 10 / 9
    assert roller.load_deflection == roller_load_deflection_factor(11e-3)
    assert BEARINGS["rexnord_za2115"].load_deflection.assumed


def test_only_the_other_rigs_assume_masses_supports_and_resonators():
    mechanical = {"inner_mass", "outer_mass", "support_stiffness_x", "resonator_mass", "resonator_stiffness"}
    for name, entry in RIGS.items():
        flags = {field: number.assumed for field, number in sourced_fields(entry)}
        assert all(flags[field] == (name not in ("gearbox", "fan")) for field in mechanical)


def test_every_number_has_a_unit_and_a_source_and_every_assumption_a_reason(rows):
    assert len(rows) > 100
    for row in rows:
        assert row.unit
        assert row.source
        assert row.assumed == (row.source == "assumed")
        assert row.note or not row.assumed


def test_every_field_of_a_bearing_and_a_rig_is_in_the_table(rows):
    listed = {(row.kind, row.name, row.quantity): row.value for row in rows}
    for name in RIGS:
        for field in ("inner_mass", "resonator_damping", "film_damping", "rated_speed", "rated_load"):
            assert listed["rig", name, field] == getattr(rig(name), field)
    for name in BEARINGS:
        for field in ("balls", "pitch_diameter", "load_deflection", "clearance", "contact_angle"):
            assert listed["bearing", name, field] == getattr(bearing(name), field)


def test_numbers_that_contradict_their_source_are_noted_with_both_values(rows):
    notes = {(row.name, row.quantity): row.note for row in rows if row.quantity.endswith("(printed)")}
    assert notes["gearbox", "bpfo (printed)"].startswith("source prints 34.2, its numbers give 34.28")
    assert notes["gearbox", "resonator_damping_ratio (printed)"].startswith(
        "source prints 0.01, its numbers give 0.0049"
    )
    assert notes["fan", "upper mode along y (printed)"].startswith("source prints 1.99e3, its numbers give 1996.4")
    assert not any("(agrees)" in notes[key] for key in list(notes) if key[1].startswith("sixth harmonic"))
    assert notes["mfpt", "bpfo (printed)"].endswith("; from inches rounded to millimetres")
    for agreed in ("bpfo", "resonator_frequency", "resonator_damping_ratio", "lower mode along y"):
        assert "(agrees)" in notes["fan", f"{agreed} (printed)"]


@pytest.mark.parametrize(
    ("name", "quantity", "computed"),
    [
        ("gearbox", "balls within the 40 degree spall", 40.0 / (360.0 / 12.0)),
        ("fan", "extent of a 1.2 mm spall", math.degrees(1.2 / ((45.0 + 8.0) / 2.0))),
        # The outer raceway is a sphere, whose radius over the ball's diameter is the conformity.
        ("gearbox", "load_deflection", load_deflection_factor(38.75e-3, 7.12e-3, outer_conformity=45.87 / 14.24)),
        ("fan", "load_deflection", load_deflection_factor(45e-3, 8e-3, outer_conformity=53.0 / 16.0)),
        # A ball in a sphere, 22.935 mm in radius: Hertz's circle, a³ = 3 F R (1 − ν²) / (2 E). The most loaded of 24
        # balls carries Stribeck's 4.37 of their mean load.
        (
            "gearbox",
            "contact width",
            2.0 * (1.5 * 4.37 * 346.0 / 24.0 / (1.0 / 3.56e-3 - 1.0 / 22.935e-3) * 0.91 / 206e9) ** (1.0 / 3.0),
        ),
    ],
)
def test_beside_what_a_source_prints_stands_what_its_geometry_gives(rows, name, quantity, computed):
    [note] = [row.note for row in rows if (row.name, row.quantity) == (name, f"{quantity} (printed)")]
    told = float(note.split("numbers give ")[1].split()[0].rstrip(";"))
    assert told == pytest.approx(computed, rel=1e-5)  # six digits


@pytest.mark.parametrize(("name", "agrees"), [("cwru", True), ("ims", True), ("mfpt", False)])
def test_both_printed_ball_pass_frequencies_stand_beside_what_the_geometry_gives(rows, name, agrees):
    notes = {row.quantity: row for row in rows if row.name == name}
    for quantity in ("bpfo", "bpfi"):
        row = notes[f"{quantity} (printed)"]
        assert ("(agrees)" in row.note) is agrees
        computed = float(row.note.split("numbers give ")[1].split()[0].rstrip(";"))
        assert computed == pytest.approx(row.value, rel=1e-4)  # inches rounded to millimetres move it by 3e-5


@pytest.mark.parametrize(
    ("printed", "value", "agrees"),
    [("34.2", 34.249, True), ("34.2", 34.26, False), ("9.7e3", 9749.0, True), ("9.7e3", 9755.0, False)],
)
def test_a_claim_agrees_when_the_value_rounds_to_the_printed_digits(printed, value, agrees):
    assert Claim("q", printed, "Hz", "s", lambda rig: 0.0).agrees(value) is agrees


@pytest.mark.parametrize("name", sorted(RIGS))
def test_the_film_damping_of_every_rig_lies_in_the_paper_s_range(authority, name):
    allowed = authority("petersen_2014")["printed"]["film_damping_per_stiffness"]
    stiffness, damping = rated_matrices(rig(name))
    for axis in (0, 1):
        share = damping[axis, axis] / stiffness[axis, axis]
        assert allowed["lowest"] <= share <= allowed["highest"]


@pytest.mark.parametrize("name", sorted(RIGS))
def test_every_rig_has_support_bearing_and_resonator_modes_where_machines_have_them(name):
    found = modes(rig(name), *rated_matrices(rig(name)))
    assert 100 < found.frequency_hz[0] < 1000
    assert 500 < found.frequency_hz[3] < 4000
    assert 3900 < found.frequency_hz[4] < found.frequency_hz[5] < 11000
    assert found.frequency_hz[4] > 1.5 * found.frequency_hz[3]
    assert found.damping_ratio.min() > 0.004
    assert found.damping_ratio.max() < 0.07


@pytest.mark.parametrize(
    ("entry", "stiffness", "mass", "damping", "percent"),
    [
        (name, stiffness, mass, damping, percent)
        for name in ("cwru", "mfpt", "ims")
        for stiffness, mass, damping, percent in (
            ("support_stiffness_x", "outer_mass", "support_damping_x", 3.0),
            ("support_stiffness_y", "outer_mass", "support_damping_y", 3.0),
            ("resonator_stiffness", "resonator_mass", "resonator_damping", 2.0),
        )
    ],
)
def test_assumed_dampings_are_the_share_of_critical_that_their_note_says(entry, stiffness, mass, damping, percent):
    machine = rig(entry)
    critical = 2 * math.sqrt(getattr(machine, stiffness) * getattr(machine, mass))
    assert 100 * getattr(machine, damping) / critical == pytest.approx(percent, abs=0.05)  # rounded in the catalogue
    assert f"{percent:g} %" in getattr(RIGS[entry], damping).note


@pytest.mark.parametrize("name", ["cwru", "mfpt", "ims"])
def test_assumed_supports_are_as_stiff_both_ways_and_put_the_lowest_mode_where_their_note_says(name):
    along, across = RIGS[name].support_stiffness_x, RIGS[name].support_stiffness_y
    assert along == across
    lowest = modes(rig(name), *rated_matrices(rig(name))).frequency_hz[0]
    assert 250.0 <= lowest <= 650.0


@pytest.mark.parametrize("name", ["koyo_1205", "nachi_2206gk", "rexnord_za2115"])
def test_two_rows_are_staggered_by_half_the_spacing_that_their_note_says(name):
    assert BEARINGS[name].row_offset.note.startswith("half the ")
    assert bearing(name).stagger == pytest.approx(math.pi / bearing(name).balls, rel=EXACT)


@pytest.mark.parametrize(
    ("entry", "play_um"),
    [("skf_6205", 6), ("skf_6203", 6), ("ldk_uer204", 6), ("nice_mfpt", 6), ("rexnord_za2115", 20)],
)
def test_an_assumed_clearance_is_half_of_the_play_that_its_note_says(entry, play_um):
    assert f"half of a diametral play of {play_um} µm" in BEARINGS[entry].clearance.note
    assert BEARINGS[entry].clearance.value == pytest.approx(0.5e-6 * play_um)


def test_self_aligning_bearings_have_a_spherical_outer_raceway():
    for name in ("koyo_1205", "nachi_2206gk"):
        ring = bearing(name)
        assert ring.outer_conformity * ring.ball_diameter == pytest.approx(ring.raceway_radius("outer"), rel=EXACT)


@pytest.mark.parametrize(
    ("call", "wrong", "nearest"),
    [(rig, "gear_box", "gearbox"), (rig, "fans", "fan"), (bearing, "koyo1205", "koyo_1205")],
)
def test_an_unknown_name_is_refused_with_the_nearest_known_one(call, wrong, nearest):
    with pytest.raises(InvalidParameter, match=f'"{wrong}" is not in the catalogue.*did you mean "{nearest}"'):
        call(wrong)


def test_a_name_near_to_none_is_refused_with_the_list_of_names():
    with pytest.raises(InvalidParameter, match=r"gearbox, fan, cwru, mfpt, ims$"):
        rig("zzz")

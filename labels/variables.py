"""The tables of a corpus's arrays (coordinates, signals, ball passes, defects), over which formats and checks loop."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from labels.schema import BAND_EDGES, LAYERS, LOCATIONS
from physics.words import STIFFNESS_COMPONENTS

AXES = ("x", "y")
NO_DIP = (
    "the ball of the simulated motion does not touch both races all the way from entry to exit, whatever its "
    "quasi-static load (as where it has a release_time), the pass is cut by an end of the record, or the load does not "
    "fall from above half and rise again"
)


@dataclass(frozen=True)
class Variable:
    """One array of a corpus.

    `unit` is in UDUNITS; `missing` as for labels. `stored` says which records have it:

    - "always": all
    - "simulated": all simulated ones (an imported recording perhaps); "imported": all imported ones
    - "changing speed": recordings whose speed is known to change
    - any other word: those whose recipe asks for it by that key of its table `store`
    """

    name: str
    dims: tuple[str, ...]
    dtype: str
    unit: str
    long_name: str
    sentence: str
    stored: str = "always"
    values: tuple[str, ...] | None = None
    missing: str = ""

    def required(self, imported: bool) -> bool:
        """True if every record of a simulated (or an imported) corpus has it."""
        return self.stored in ("always", "imported" if imported else "simulated")


_simulated = partial(Variable, stored="simulated")

COORDINATES: tuple[Variable, ...] = (
    Variable("record", ("record",), "int64", "1", "record", "Index of the record in the whole corpus, from 0."),
    Variable("time", ("time",), "float64", "s", "time", "Time from the start of the record."),
    Variable("axis", ("axis",), "str", "", "axis", "Direction: y is up, against the static load.", values=AXES),
    Variable(
        "stiffness_time", ("stiffness_time",), "float64", "s", "time of the stiffness", "Time of the stored stiffness."
    ),
    Variable(
        "component",
        ("component",),
        "str",
        "",
        "component",
        "Element of the symmetric matrix.",
        values=STIFFNESS_COMPONENTS,
    ),
    Variable("row", ("row",), "int64", "1", "row", "Row of balls, from 1."),
    Variable("ball", ("ball",), "int64", "1", "ball", "Ball of a row, from 1, in the direction of rotation."),
    Variable(
        "profile_angle",
        ("profile_angle",),
        "float64",
        "rad",
        "angle on the race",
        "Angle fixed to the defective race and equal to the angle in space at t = 0; from -pi to pi, end excluded.",
    ),
    Variable("band_edge", ("band_edge",), "str", "", "band edge", "Edge of a frequency band.", values=BAND_EDGES),
    Variable("layer", ("layer",), "str", "", "layer", "Layer of the background.", values=LAYERS),
)

SIGNALS: tuple[Variable, ...] = (
    Variable(
        "acceleration",
        ("record", "time", "axis"),
        "float32",
        "m s-2",
        "acceleration",
        "Acceleration as the sensor gives it, with the background.",
    ),
    Variable(
        "envelope",
        ("record", "time"),
        "float32",
        "m s-2",
        "envelope of the acceleration",
        "Magnitude of the analytic signal of the acceleration along y in the record's envelope_band: its Fourier "
        "components in the band, edges included, are kept and all others dropped. The record counts as periodic, which "
        "touches the first and last 1/(width of the band) seconds.",
        stored="simulated",
    ),
    Variable(
        "stiffness",
        ("record", "component", "stiffness_time"),
        "float32",
        "N m-1",
        "stiffness of the bearing",
        "Quasi-static stiffness at each instant's load, cage angle and spall position; read by linear interpolation.",
        stored="simulated",
    ),
    Variable(
        "acceleration_clean",
        ("record", "time", "axis"),
        "float32",
        "m s-2",
        "clean acceleration",
        "Acceleration of the resonator's mass before any sensor path, filter or background.",
        stored="clean",
    ),
    Variable(
        "acceleration_sensor",
        ("record", "time", "axis"),
        "float32",
        "m s-2",
        "acceleration at the sensor",
        "Acceleration after sensor paths and mounting, before background and recorder.",
        stored="sensor",
    ),
    Variable(
        "background",
        ("record", "layer", "time", "axis"),
        "float32",
        "m s-2",
        "background",
        "Layers of the background; their sum plus acceleration_sensor is what the recorder is given.",
        stored="background",
    ),
    Variable(
        "cage_angle",
        ("record", "time"),
        "float64",
        "rad",
        "angle of the cage",
        "Unwrapped angle of ball 1 of row 1, counter-clockwise from +x.",
        stored="cage_angle",
    ),
    Variable(
        "profile_depth",
        ("record", "row", "profile_angle"),
        "float32",
        "m",
        "depth of the ball's path",
        "Drop of the ball's centre by the defective race, its spalls and its waviness together; read by periodic "
        "linear interpolation, which is too coarse for tapers below 0.03 degrees and gaps of some 10 um.",
        stored="profile",
    ),
    Variable(
        "contact_force",
        ("record", "time", "row", "ball"),
        "float32",
        "N",
        "contact force",
        "Normal force of each ball, positive when it pushes.",
        stored="contact_force",
        missing="the record's forces were not asked for",
    ),
)

SHAFT_ANGLE = Variable(
    "shaft_angle",
    ("record", "time"),
    "float64",
    "rad",
    "angle of the shaft",
    "Angle turned by the shaft since the start of the record, as a tach or a channel of its speed tells.",
    stored="changing speed",
)

SCENARIO = Variable(
    "scenario",
    ("record",),
    "str",
    "",
    "scenario",
    "JSON text with every number that is needed to simulate the record; phi_f to roughness of its parameters are those "
    "of the longest of its defects.",
    stored="simulated",
)

PROVENANCE = Variable(
    "provenance",
    ("record",),
    "str",
    "",
    "provenance",
    "JSON text: which numbers of which file the record is, how they were scaled, and notes that came with them.",
    stored="imported",
)

PASSES: tuple[Variable, ...] = (
    _simulated("pass_record", ("ball_pass",), "int64", "1", "record of the pass", "Record in which the ball passes."),
    _simulated("pass_row", ("ball_pass",), "int16", "1", "row of the pass", "Row of the ball, from 1."),
    _simulated("pass_ball", ("ball_pass",), "int16", "1", "ball of the pass", "Ball of its row, from 1."),
    _simulated(
        "pass_defect",
        ("ball_pass",),
        "int16",
        "1",
        "defect of the pass",
        "Which spall of the record is passed: place among the record's rows of the defect table, from 0.",
    ),
    _simulated(
        "entry_time",
        ("ball_pass",),
        "float64",
        "s",
        "time of entry",
        "The ball's centre reaches the edge met first; below 0 if the pass began before the record. Outside the "
        "record the cage is taken to turn at nominal_speed (1 - mean_slip) of the scenario's slip.",
    ),
    _simulated(
        "deepest_time",
        ("ball_pass",),
        "float64",
        "s",
        "time at the deepest point",
        "The ball's centre is at the deepest point of its path, or at the middle of a flat floor.",
    ),
    _simulated(
        "exit_time", ("ball_pass",), "float64", "s", "time of exit", "The ball's centre reaches the edge met last."
    ),
    _simulated(
        "release_time",
        ("ball_pass",),
        "float64",
        "s",
        "time of release",
        "First loss of contact between entry and exit: compression becomes zero, or, with the contact law no_tension, "
        "the force does while the film would pull.",
        missing="the ball never lost contact during the pass, or did not touch at entry (at t = 0 if it began before)",
    ),
    _simulated(
        "regain_time",
        ("ball_pass",),
        "float64",
        "s",
        "time of regained contact",
        "Contact begins again after the last loss between entry and exit; may lie after exit. With the contact law "
        "no_tension, where the force is above zero again.",
        missing="the ball was not released, or takes no load again within the record",
    ),
    _simulated(
        "loaded",
        ("ball_pass",),
        "bool",
        "",
        "loaded",
        "True if the ball touches both races at some moment of the pass.",
    ),
    _simulated(
        "complete",
        ("ball_pass",),
        "bool",
        "",
        "complete",
        "True if entry, exit and, of a ball that is released, release and regain lie inside the record.",
    ),
    _simulated(
        "fall_time",
        ("ball_pass",),
        "float64",
        "s",
        "time of the falling load",
        "First fall of the ball's quasi-static load through half of what it would be without spalls, seen in 400 equal "
        "steps from entry to exit: over a rough floor a shorter dip may lie before.",
        missing=NO_DIP,
    ),
    _simulated(
        "rise_time",
        ("ball_pass",),
        "float64",
        "s",
        "time of the rising load",
        "Last rise of the ball's quasi-static load through half of what it would be without spalls, seen likewise.",
        missing=NO_DIP,
    ),
)

DEFECTS: tuple[Variable, ...] = (
    _simulated(
        "defect_record", ("defect",), "int64", "1", "record of the defect", "Record to which the spall belongs."
    ),
    _simulated(
        "defect_race",
        ("defect",),
        "str",
        "",
        "race of the defect",
        "Race that carries the spall.",
        values=LOCATIONS[1:],
    ),
    _simulated("defect_row", ("defect",), "int16", "1", "row of the defect", "Row of balls that meets it, from 1."),
    _simulated(
        "defect_angle",
        ("defect",),
        "float64",
        "rad",
        "angle of the defect",
        "Centre of the spall at t = 0, counter-clockwise from +x; an inner one turns with the shaft.",
    ),
    _simulated("defect_extent", ("defect",), "float64", "rad", "extent of the defect", "Arc covered by the spall."),
    _simulated("defect_depth", ("defect",), "float64", "m", "depth of the defect", "Depth of the floor of the spall."),
)

VARIABLES: tuple[Variable, ...] = (*COORDINATES, *SIGNALS, SHAFT_ANGLE, SCENARIO, PROVENANCE, *PASSES, *DEFECTS)

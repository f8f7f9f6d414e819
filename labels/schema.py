"""The one table of labels: formats, checks, indices and pages loop over it.

Adding a label means adding one row to LABELS and computing it where its `source` says.
"""

from __future__ import annotations

from dataclasses import dataclass

from physics.bearing import RACES
from physics.spall import PROFILES
from physics.words import CONTACT_LAWS

HEALTHY = "healthy"
CONDITIONS = (HEALTHY, "line", "extended")
LOCATIONS = ("none", *RACES)
SPLITS = ("train", "validation", "test")
SPEED_BASES = ("set", "measured", "tach", "nominal")
UNKNOWN = "unknown"
MEASURED = "measured"
BAND_EDGES = ("low", "high")
LAYERS = ("white", "pink", "shaft_harmonics", "gear_mesh", "mains_hum", "impulses", "recording")


@dataclass(frozen=True)
class Label:
    """One fact about a record.

    `dtype` is "str", "float64", "int64" or "bool"; `unit` a UDUNITS text, "" for text and truth values.
    `values` are the allowed texts of a generated record (None: any text); an imported recording may also say one of
    `imported`. `missing` says in words when NaN stands for "not applicable" ("" if it never does); an imported
    recording may have NaN for any number that is unknown, and then leaves unknown truth values and counts out.
    `source` says who computes it: "scene" (labels.description), "run" (the simulation), "record" (the corpus) or
    "recording" (an imported file; empty in a simulated record).
    `components` name the values of a label that has several; in a flat table each becomes `name_component`.
    """

    name: str
    dtype: str
    unit: str
    sentence: str
    source: str
    values: tuple[str, ...] | None = None
    imported: tuple[str, ...] = ()
    missing: str = ""
    components: tuple[str, ...] = ()

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the label's columns in a table with one number or text a cell."""
        return tuple(f"{self.name}_{part}" for part in self.components) or (self.name,)


def _text(
    name: str, source: str, sentence: str, values: tuple[str, ...] | None = None, imported: tuple[str, ...] = ()
) -> Label:
    return Label(name, "str", "", sentence, source, values, imported)


def _number(
    name: str, unit: str, source: str, sentence: str, missing: str = "", components: tuple[str, ...] = ()
) -> Label:
    return Label(name, "float64", unit, sentence, source, missing=missing, components=components)


def _count(name: str, source: str, sentence: str) -> Label:
    return Label(name, "int64", "1", sentence, source)


LABELS: tuple[Label, ...] = (
    _count("record", "record", "Index of the record in the whole corpus, from 0."),
    _text("part", "record", "Name of the recipe's part that the record belongs to."),
    _text("recording", "recording", "Name of the recording; empty for a simulated record."),
    _text("channel", "recording", "Name of the sensor's channel; empty if it has none or was simulated."),
    _text("source_file", "recording", "File that the recording was read from; empty for a simulated record."),
    _text("split", "record", "Share of the corpus, chosen by virtual bearing and never by record.", SPLITS, (UNKNOWN,)),
    _text("rig", "scene", "Name of the machine around the bearing."),
    _text("bearing", "scene", "Designation of the bearing."),
    _text("bearing_id", "record", "The virtual bearing: records with the same value must stay in the same split."),
    _text(
        "condition",
        "scene",
        "healthy, or line (shorter than the ball spacing), or extended (always holds at least one ball).",
        CONDITIONS,
        (UNKNOWN,),
    ),
    _text(
        "location",
        "scene",
        "The defective race.",
        LOCATIONS,
        ("ball", "cage", "several", UNKNOWN),
    ),
    _count("spalls", "scene", "Number of spalls; the labels below describe the longest of them."),
    _number("extent", "rad", "scene", "Arc covered by the spall; 0 when healthy."),
    _number("extent_mm", "mm", "scene", "Length of the spall along its raceway; 0 when healthy."),
    _number("extent_spacing", "1", "scene", "Arc covered by the spall over the ball spacing of a row; 0 when healthy."),
    _number("depth", "m", "scene", "Depth of the spall's floor below the raceway; 0 when healthy."),
    _number("path_depth", "m", "scene", "Largest drop of a ball's centre on its way over the spall; 0 when healthy."),
    Label(
        "bridged",
        "bool",
        "",
        "True if both edges carry the ball, so that it never reaches the floor: it stays more than 2 % of depth above "
        "all of it between the tapers, or above all places of a measured table that are half as deep as its deepest.",
        "scene",
    ),
    _number("entry_taper", "rad", "scene", "Arc of the taper that a ball meets first; 0 when healthy."),
    _number("exit_taper", "rad", "scene", "Arc of the taper that a ball meets last; 0 when healthy."),
    _number("roughness", "m", "scene", "Standard deviation of the surface inside the spall; 0 when healthy."),
    _text(
        "profile",
        "scene",
        "Rule by which the path of the ball's centre follows from the spall.",
        ("none", *PROFILES),
        (UNKNOWN,),
    ),
    _number("speed_rpm", "rpm", "scene", "Mean speed of the shaft in revolutions per minute."),
    _text(
        "speed_basis",
        "record",
        "How the speed is known: set (simulated), measured beside the vibration, from a tach, or nominal.",
        SPEED_BASES[:1],
        (*SPEED_BASES[1:], UNKNOWN),
    ),
    _number("load_n", "N", "scene", "Static radial load on the shaft, along -y."),
    _number("mean_slip", "1", "scene", "Mean slip of the cage of row 1 over the record, of its speed without slip."),
    _number("slip_deviation", "1", "scene", "Standard deviation of that slip about its mean over the record."),
    _text(
        "contact_law",
        "scene",
        "Whether the oil film may pull a ball (paper) or not (no_tension).",
        CONTACT_LAWS,
        (UNKNOWN,),
    ),
    _count("balls", "scene", "Rolling elements in one row."),
    _count("rows", "scene", "Rows of rolling elements."),
    _number("pitch_diameter", "m", "scene", "Diameter of the circle through the balls' centres."),
    _number("ball_diameter", "m", "scene", "Diameter of a rolling element."),
    _number("contact_angle", "rad", "scene", "Contact angle."),
    _number("bpfo", "1", "scene", "Ball-pass frequency of the outer race without slip, in orders of the shaft."),
    _number("bpfi", "1", "scene", "Ball-pass frequency of the inner race without slip, in orders of the shaft."),
    _number("bsf", "1", "scene", "Spin frequency of a ball without slip, in orders of the shaft."),
    _number("ftf", "1", "scene", "Frequency of the cage without slip, in orders of the shaft."),
    _number("rate_hz", "Hz", "record", "Sampling rate of the vibration."),
    _number("duration_s", "s", "record", "Length of the record."),
    _number(
        "snr_db",
        "dB",
        "record",
        "Power of the sensor's signal over that of the background, y axis, each without its mean, up to half the "
        "sampling rate.",
        "the record has no background, or its sensor no signal",
    ),
    _number(
        "snr_band_db",
        "dB",
        "record",
        "Power of the sensor's signal over that of the background, y axis, over snr_band.",
        "the record has no background in that band, or its sensor no signal there",
    ),
    _number("snr_band", "Hz", "record", "Lower and upper edge of the band of snr_band_db.", components=BAND_EDGES),
    _text("background_layers", "record", "Names of the background's layers, joined by ', '; empty without background."),
    _number(
        "background_rms",
        "m s-2",
        "record",
        "RMS of each layer of the background, y axis; 0 where the layer is absent.",
        components=LAYERS,
    ),
    _count("sensor_modes", "record", "Resonances between outer ring and sensor, besides the resonator."),
    _number(
        "mounting_cutoff_hz", "Hz", "record", "Half-power frequency of the sensor's mounting.", "it passes everything"
    ),
    _number(
        "recorder_step",
        "m s-2",
        "record",
        "Distance between two values that the recorder holds.",
        "the recorder does not round",
    ),
    _number(
        "clipped_share",
        "1",
        "record",
        "Share of samples, both axes, whose rounded value lies beyond the recorder's range.",
    ),
    _number(
        "envelope_band",
        "Hz",
        "record",
        "Lower and upper edge of the band of the stored envelope. Of a simulated record whose recipe states none: 5 % "
        "to either side of the mode along y that strains the resonator's spring most, of the healthy bearing at the "
        "rated load: undamped, of all six degrees of freedom, without imperfections and with the cage at angle 0.",
        components=BAND_EDGES,
    ),
    _text("model", "run", 'Model that made the signal; "measured" if a real machine did.'),
    _text("method", "run", 'Integrator that solved it; "none" if nothing was solved.'),
    _number(
        "step",
        "s",
        "run",
        "Mean time step of a method that chooses its own for the accuracy, else the longest step of the integrator.",
        "nothing was solved in steps, or they were not counted",
    ),
    _number(
        "error_estimate",
        "1",
        "run",
        "Estimated RMS error of the clean acceleration over its RMS; where errors below the noise are allowed it is a "
        "bound, which a quiet signal is far below. Against this program's own paths and rounding: where contacts "
        "multiply errors, which `validity` says where this record showed it, other programs' rounding leads "
        "elsewhere.",
        "the error was not estimated",
    ),
    _number(
        "tension_share",
        "1",
        "run",
        "Share of contact time, summed over the balls, in which the oil film pulls; of all that was simulated, so with "
        "the lead-in (settle_s), and of a response that repeats itself as far as it was marched.",
        "the forces of single balls were not followed",
    ),
    _number(
        "stiffness_error",
        "1",
        "record",
        "Estimated RMS error of the stored stiffness, read by linear interpolation at the instants of the samples, "
        "over the mean of kyy; the true one is usually several times smaller. Single instants, and those between "
        "samples where a ball takes or loses its load, may be off by more.",
        "it was not measured",
    ),
    _text(
        "validity",
        "scene",
        "Why to read it with care, sentences joined by '; ': where it leaves the model's range, or that it is chaotic.",
    ),
)

LABEL: dict[str, Label] = {label.name: label for label in LABELS}

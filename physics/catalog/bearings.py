"""Geometries of bearings whose test rigs are published, each number with its source."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from physics.bearing import DEFAULT_CONFORMITY, Bearing
from physics.catalog.sourced import Sourced, assumed, sourced_fields
from physics.hertz import ROLLER_EXPONENT, load_deflection_factor, roller_load_deflection_factor

PAPER_GEARBOX = "Petersen et al. 2014, section 5.1"
PAPER_GEARBOX_TABLE = "Petersen et al. 2014, Table 1"
PAPER_MODEL = "Petersen et al. 2014, section 5.2"
PAPER_FAN = "Petersen et al. 2014, section 6.1"
PAPER_FAN_TABLE = "Petersen et al. 2014, Table 2"
PAPER_LAW = "Petersen et al. 2014, Eq. 6"
CWRU = "Case Western Reserve University Bearing Data Center, bearing information"
MFPT = "MFPT Society fault data sets (E. Bechhoefer), bearing information"
XJTU = "XJTU-SY bearing datasets, bearing parameters; Wang et al. 2020, IEEE Trans. Reliab. 69"
IMS = "IMS run-to-failure data (NASA prognostics repository), readme; Qiu et al. 2006, J. Sound Vib. 289"

ASSUMED_ROLLER_LENGTH = 11e-3

_ball_law = Sourced(1.5, "1", PAPER_LAW, note="balls")
_usual_conformity = assumed(DEFAULT_CONFORMITY, "1", "groove radius / ball diameter, usual for steel ball bearings")
_usual_play = assumed(3e-6, "m", "a usual fit: half of a diametral play of 6 µm when mounted")
_conformity_without_effect = assumed(DEFAULT_CONFORMITY, "1", "without effect: rollers touch along lines")


@dataclass(frozen=True)
class CatalogBearing:
    """A named bearing; each number as in `physics.bearing.Bearing`, with its source."""

    title: str
    balls: Sourced
    rows: Sourced
    pitch_diameter: Sourced
    ball_diameter: Sourced
    load_deflection: Sourced
    clearance: Sourced
    contact_angle: Sourced
    exponent: Sourced = _ball_law
    row_offset: Sourced | None = None
    inner_conformity: Sourced = _usual_conformity
    outer_conformity: Sourced = _usual_conformity

    def build(self, name: str) -> Bearing:
        """The bearing without its sources."""
        numbers: dict[str, Any] = {field: number.value for field, number in sourced_fields(self)}
        return Bearing(name=name, **numbers)


def _sphere(pitch_diameter: float, ball_diameter: float, source: str) -> Sourced:
    return Sourced(
        (pitch_diameter + ball_diameter) / (2.0 * ball_diameter),
        "1",
        source,
        note="self-aligning: the outer raceway is a sphere, so its groove radius is the raceway radius",
    )


def _from_geometry(pitch_diameter: float, ball_diameter: float) -> Sourced:
    return assumed(
        load_deflection_factor(pitch_diameter, ball_diameter),
        "N/m^1.5",
        "Hertz factor from geometry: conformity 0.52, E 206 GPa, Poisson's ratio 0.3, angle 0",
    )


KOYO_1205 = CatalogBearing(
    title="Koyo 1205 double row self-aligning ball bearing",
    balls=Sourced(12, "1", PAPER_GEARBOX, note="on each row"),
    rows=Sourced(2, "1", PAPER_GEARBOX),
    pitch_diameter=Sourced(38.75e-3, "m", PAPER_GEARBOX),
    ball_diameter=Sourced(7.12e-3, "m", PAPER_GEARBOX),
    load_deflection=Sourced(5157e6, "N/m^1.5", PAPER_GEARBOX_TABLE),
    clearance=Sourced(0.0, "m", PAPER_MODEL, note="the source calls it assumed"),
    contact_angle=Sourced(0.0, "rad", PAPER_GEARBOX),
    row_offset=Sourced(math.pi / 12, "rad", PAPER_GEARBOX, note="half the ball spacing, one cage"),
    outer_conformity=_sphere(38.75e-3, 7.12e-3, PAPER_GEARBOX),
)

NACHI_2206GK = CatalogBearing(
    title="Nachi 2206GK double row self-aligning ball bearing",
    balls=Sourced(14, "1", PAPER_FAN, note="on each row"),
    rows=Sourced(2, "1", PAPER_FAN),
    pitch_diameter=Sourced(45e-3, "m", PAPER_FAN),
    ball_diameter=Sourced(8e-3, "m", PAPER_FAN),
    load_deflection=Sourced(10.1e9, "N/m^1.5", PAPER_FAN_TABLE),
    clearance=Sourced(3e-6, "m", PAPER_FAN),
    contact_angle=Sourced(0.0, "rad", PAPER_FAN),
    row_offset=Sourced(math.pi / 14, "rad", PAPER_FAN, note="half the ball spacing, one cage"),
    outer_conformity=_sphere(45e-3, 8e-3, PAPER_FAN),
)

SKF_6205 = CatalogBearing(
    title="SKF 6205-2RS deep groove ball bearing (CWRU, drive end)",
    balls=Sourced(9, "1", CWRU),
    rows=Sourced(1, "1", CWRU),
    pitch_diameter=Sourced(39.04e-3, "m", CWRU, note="1.537 in"),
    ball_diameter=Sourced(7.94e-3, "m", CWRU, note="0.3126 in"),
    load_deflection=_from_geometry(39.04e-3, 7.94e-3),
    clearance=_usual_play,
    contact_angle=Sourced(0.0, "rad", CWRU),
)

SKF_6203 = CatalogBearing(
    title="SKF 6203-2RS deep groove ball bearing (CWRU, fan end)",
    balls=Sourced(8, "1", CWRU),
    rows=Sourced(1, "1", CWRU),
    pitch_diameter=Sourced(28.499e-3, "m", CWRU, note="1.122 in"),
    ball_diameter=Sourced(6.746e-3, "m", CWRU, note="0.2656 in"),
    load_deflection=_from_geometry(28.499e-3, 6.746e-3),
    clearance=_usual_play,
    contact_angle=Sourced(0.0, "rad", CWRU),
)

LDK_UER204 = CatalogBearing(
    title="LDK UER204 insert ball bearing (XJTU-SY)",
    balls=Sourced(8, "1", XJTU),
    rows=assumed(1, "1", "the source gives one set of 8 balls"),
    pitch_diameter=Sourced(34.55e-3, "m", XJTU),
    ball_diameter=Sourced(7.92e-3, "m", XJTU),
    load_deflection=_from_geometry(34.55e-3, 7.92e-3),
    clearance=_usual_play,
    contact_angle=Sourced(0.0, "rad", XJTU),
)

NICE_MFPT = CatalogBearing(
    title="NICE bearing of the MFPT test rig",
    balls=Sourced(8, "1", MFPT),
    rows=assumed(1, "1", "the source gives one set of 8 elements"),
    pitch_diameter=Sourced(31.62e-3, "m", MFPT, note="1.245 in"),
    ball_diameter=Sourced(5.969e-3, "m", MFPT, note="0.235 in; the source says roller diameter"),
    load_deflection=_from_geometry(31.62e-3, 5.969e-3),
    clearance=_usual_play,
    contact_angle=Sourced(0.0, "rad", MFPT),
    exponent=assumed(1.5, "1", "taken for balls: the source gives a diameter but neither type nor length"),
)

REXNORD_ZA2115 = CatalogBearing(
    title="Rexnord ZA-2115 double row roller bearing (IMS)",
    balls=Sourced(16, "1", IMS, note="on each row"),
    rows=Sourced(2, "1", IMS),
    pitch_diameter=Sourced(71.50e-3, "m", IMS, note="2.815 in"),
    ball_diameter=Sourced(8.407e-3, "m", IMS, note="roller diameter, 0.331 in"),
    load_deflection=assumed(
        roller_load_deflection_factor(ASSUMED_ROLLER_LENGTH),
        "N/m^(10/9)",
        f"Palmgren's line contact at both races, effective roller length {ASSUMED_ROLLER_LENGTH * 1e3:g} mm assumed",
    ),
    clearance=assumed(10e-6, "m", "a usual fit: half of a diametral play of 20 µm when mounted"),
    contact_angle=Sourced(math.radians(15.17), "rad", IMS, note="15.17 degrees"),
    exponent=Sourced(ROLLER_EXPONENT, "1", PAPER_LAW, note="rollers"),
    row_offset=assumed(math.pi / 16, "rad", "half the roller spacing"),
    inner_conformity=_conformity_without_effect,
    outer_conformity=_conformity_without_effect,
)

BEARINGS: dict[str, CatalogBearing] = {
    "koyo_1205": KOYO_1205,
    "nachi_2206gk": NACHI_2206GK,
    "skf_6205": SKF_6205,
    "skf_6203": SKF_6203,
    "ldk_uer204": LDK_UER204,
    "nice_mfpt": NICE_MFPT,
    "rexnord_za2115": REXNORD_ZA2115,
}

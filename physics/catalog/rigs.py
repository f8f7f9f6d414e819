"""Published test rigs: bearing, masses, supports and operating point, each number with its source."""

from __future__ import annotations

import math
from dataclasses import dataclass

from physics.angular_speed import RPM
from physics.catalog.bearings import (
    BEARINGS,
    CWRU,
    IMS,
    MFPT,
    PAPER_FAN,
    PAPER_FAN_TABLE,
    PAPER_GEARBOX,
    PAPER_GEARBOX_TABLE,
)
from physics.catalog.claims import CWRU_CLAIMS, FAN_CLAIMS, GEARBOX_CLAIMS, IMS_CLAIMS, MFPT_CLAIMS
from physics.catalog.sourced import Claim, Sourced, assumed, sourced_fields
from physics.rig import Rig

POUND_FORCE = 4.4482216152605
LIKE_PAPER = "between the paper's two rigs"


@dataclass(frozen=True)
class CatalogRig:
    """A named rig; each number as in `physics.rig.Rig`, with its source, and what its source claims besides."""

    title: str
    bearing: str
    inner_mass: Sourced
    outer_mass: Sourced
    support_stiffness_x: Sourced
    support_stiffness_y: Sourced
    support_damping_x: Sourced
    support_damping_y: Sourced
    resonator_mass: Sourced
    resonator_stiffness: Sourced
    resonator_damping: Sourced
    film_damping: Sourced
    rated_speed: Sourced
    rated_load: Sourced
    claims: tuple[Claim, ...] = ()

    def build(self, name: str) -> Rig:
        """The rig without its sources."""
        numbers = {field: number.value for field, number in sourced_fields(self)}
        return Rig(name=name, bearing=BEARINGS[self.bearing].build(self.bearing), **numbers)


GEARBOX = CatalogRig(
    title="Gearbox test rig of Petersen et al. 2014",
    bearing="koyo_1205",
    inner_mass=Sourced(0.5134, "kg", PAPER_GEARBOX_TABLE),
    outer_mass=Sourced(10.268, "kg", PAPER_GEARBOX_TABLE),
    support_stiffness_x=Sourced(17.7e6, "N/m", PAPER_GEARBOX_TABLE),
    support_stiffness_y=Sourced(17.7e6, "N/m", PAPER_GEARBOX_TABLE),
    support_damping_x=Sourced(673.8, "N s/m", PAPER_GEARBOX_TABLE),
    support_damping_y=Sourced(673.8, "N s/m", PAPER_GEARBOX_TABLE),
    resonator_mass=Sourced(0.5, "kg", PAPER_GEARBOX_TABLE),
    resonator_stiffness=Sourced(2094.0e6, "N/m", PAPER_GEARBOX_TABLE),
    resonator_damping=Sourced(317.3, "N s/m", PAPER_GEARBOX_TABLE),
    film_damping=Sourced(100.0, "N s/m", PAPER_GEARBOX_TABLE),
    rated_speed=Sourced(2.0 * math.pi * 7.0, "rad/s", PAPER_GEARBOX, note="7 Hz"),
    rated_load=Sourced(346.0, "N", PAPER_GEARBOX, note="from a torque of 16 Nm on the gears"),
    claims=GEARBOX_CLAIMS,
)

FAN = CatalogRig(
    title="Fan test rig of Petersen et al. 2014",
    bearing="nachi_2206gk",
    inner_mass=Sourced(2.0, "kg", PAPER_FAN_TABLE),
    outer_mass=Sourced(2.5, "kg", PAPER_FAN_TABLE),
    support_stiffness_x=Sourced(262.8e6, "N/m", PAPER_FAN_TABLE),
    support_stiffness_y=Sourced(262.8e6, "N/m", PAPER_FAN_TABLE),
    support_damping_x=Sourced(2050.4, "N s/m", PAPER_FAN_TABLE),
    support_damping_y=Sourced(2050.4, "N s/m", PAPER_FAN_TABLE),
    resonator_mass=Sourced(0.1, "kg", PAPER_FAN_TABLE),
    resonator_stiffness=Sourced(371.5e6, "N/m", PAPER_FAN_TABLE),
    resonator_damping=Sourced(365.7, "N s/m", PAPER_FAN_TABLE),
    film_damping=Sourced(150.0, "N s/m", PAPER_FAN_TABLE),
    rated_speed=Sourced(800.0 * RPM, "rad/s", PAPER_FAN, note="800 rpm"),
    rated_load=Sourced(100.0, "N", PAPER_FAN),
    claims=FAN_CLAIMS,
)


def _film(value: float) -> Sourced:
    return assumed(value, "N s/m", "puts the bearing's damping at 0.25e-5 to 2.5e-5 s times its stiffness (Petersen)")


def _resonator_stiffness(value: float, hertz: str) -> Sourced:
    return assumed(value, "N/m", f"puts the resonator near {hertz}, below half the recordings' lowest sampling rate")


def _stiffness(value: float) -> Sourced:
    return assumed(value, "N/m", "puts the lowest mode at 250 to 650 Hz, as the paper's rigs have 200 and 460 Hz")


def _damping(value: float, share: str) -> Sourced:
    return assumed(value, "N s/m", f"{share} of critical")


CWRU_RIG = CatalogRig(
    title="Motor test rig around the CWRU drive-end bearing",
    bearing="skf_6205",
    inner_mass=assumed(6.0, "kg", "half the rotor of a 2 hp motor"),
    outer_mass=assumed(8.0, "kg", "ring with end shield"),
    support_stiffness_x=_stiffness(100e6),
    support_stiffness_y=_stiffness(100e6),
    support_damping_x=_damping(1700.0, "3 %"),
    support_damping_y=_damping(1700.0, "3 %"),
    resonator_mass=assumed(0.2, "kg", LIKE_PAPER),
    resonator_stiffness=_resonator_stiffness(126e6, "4 kHz"),
    resonator_damping=_damping(200.0, "2 %"),
    film_damping=_film(150.0),
    rated_speed=Sourced(1797.0 * RPM, "rad/s", CWRU, note="1797 rpm without load, 1730 at 3 hp"),
    rated_load=assumed(200.0, "N", "radial load is not published: rotor weight and magnetic pull"),
    claims=CWRU_CLAIMS,
)

MFPT_RIG = CatalogRig(
    title="Test rig around the MFPT bearing",
    bearing="nice_mfpt",
    inner_mass=assumed(2.0, "kg", "as the paper's fan rig"),
    outer_mass=assumed(5.0, "kg", LIKE_PAPER),
    support_stiffness_x=_stiffness(150e6),
    support_stiffness_y=_stiffness(150e6),
    support_damping_x=_damping(1640.0, "3 %"),
    support_damping_y=_damping(1640.0, "3 %"),
    resonator_mass=assumed(0.15, "kg", LIKE_PAPER),
    resonator_stiffness=_resonator_stiffness(480e6, "9 kHz"),
    resonator_damping=_damping(340.0, "2 %"),
    film_damping=_film(200.0),
    rated_speed=Sourced(25.0 * 2.0 * math.pi, "rad/s", MFPT, note="25 Hz"),
    rated_load=Sourced(270.0 * POUND_FORCE, "N", MFPT, note="270 lbf; other recordings 0 to 300 lbf"),
    claims=MFPT_CLAIMS,
)

IMS_RIG = CatalogRig(
    title="Endurance rig around the IMS bearings",
    bearing="rexnord_za2115",
    inner_mass=assumed(12.0, "kg", "a share of the common shaft"),
    outer_mass=assumed(10.0, "kg", "ring with housing"),
    support_stiffness_x=_stiffness(400e6),
    support_stiffness_y=_stiffness(400e6),
    support_damping_x=_damping(3800.0, "3 %"),
    support_damping_y=_damping(3800.0, "3 %"),
    resonator_mass=assumed(0.3, "kg", LIKE_PAPER),
    resonator_stiffness=_resonator_stiffness(240e6, "4.5 kHz"),
    resonator_damping=_damping(340.0, "2 %"),
    film_damping=_film(1000.0),
    rated_speed=Sourced(2000.0 * RPM, "rad/s", IMS, note="2000 rpm"),
    rated_load=Sourced(6000.0 * POUND_FORCE, "N", IMS, note="6000 lbf; taken as the load of one of the four bearings"),
    claims=IMS_CLAIMS,
)

RIGS: dict[str, CatalogRig] = {
    "gearbox": GEARBOX,
    "fan": FAN,
    "cwru": CWRU_RIG,
    "mfpt": MFPT_RIG,
    "ims": IMS_RIG,
}

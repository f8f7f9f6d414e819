"""What the sources of the catalogue print besides their parameters, beside what those parameters give."""

from __future__ import annotations

import math

from physics.angular_speed import in_hertz
from physics.catalog.bearings import (
    CWRU,
    IMS,
    MFPT,
    PAPER_FAN,
    PAPER_FAN_TABLE,
    PAPER_GEARBOX,
    PAPER_GEARBOX_TABLE,
    PAPER_MODEL,
)
from physics.catalog.sourced import Claim
from physics.hertz import contact_width, hertz_load_deflection
from physics.rig import Rig

PAPER_MODES = "Petersen et al. 2014, section 6.2"
PAPER_RESPONSE = "Petersen et al. 2014, section 5.6"


def bpfo_hz(rig: Rig) -> float:
    """Ball-pass frequency of the outer race at rated speed, Hz."""
    return in_hertz(rig.bearing.bpfo * rig.rated_speed)


def bpfi_hz(rig: Rig) -> float:
    """Ball-pass frequency of the inner race at rated speed, Hz."""
    return in_hertz(rig.bearing.bpfi * rig.rated_speed)


def resonator_alone_hz(rig: Rig) -> float:
    """√(k_r/m_r) in Hz."""
    return in_hertz(math.sqrt(rig.resonator_stiffness / rig.resonator_mass))


def resonator_damping_ratio(rig: Rig) -> float:
    """c_r as a share of critical damping."""
    return rig.resonator_damping / (2.0 * math.sqrt(rig.resonator_stiffness * rig.resonator_mass))


def hertz_factor(rig: Rig) -> float:
    """K from the geometry and conformities of the rig's ball bearing, N/m^1.5."""
    return hertz_load_deflection(rig.bearing)


def peak_contact_width(rig: Rig) -> float:
    """Width of the outer contact of the most loaded ball at rated load, m."""
    return contact_width(rig.bearing, "outer", rig.bearing.stribeck_peak_load(rig.rated_load))


def coupled_resonator_hz(rig: Rig) -> float:
    """Frequency at which the resonator rings on the outer ring, Hz."""
    # Statics brings the compiler, which those who only read a rig's numbers need not load.
    from physics.modes import coupled_resonator_frequency, rated_matrices

    return coupled_resonator_frequency(rig, rated_matrices(rig)[0])


def mode_hz(rig: Rig, number: int) -> float:
    """Undamped frequency of mode `number` (from 1) of the healthy rig at rated load, cage angle 0, Hz."""
    from physics.modes import modes, rated_matrices

    return float(modes(rig, *rated_matrices(rig)).frequency_hz[number - 1])


GEARBOX_CLAIMS = (
    Claim("bpfo", "34.2", "Hz", PAPER_GEARBOX, bpfo_hz),
    Claim("sixth harmonic of bpfo", "205.2", "Hz", PAPER_RESPONSE, lambda rig: 6.0 * bpfo_hz(rig)),
    Claim("resonator_frequency", "10.3e3", "Hz", PAPER_MODEL, resonator_alone_hz, "the resonator alone"),
    Claim(
        "resonance in the response",
        "10.3e3",
        "Hz",
        PAPER_RESPONSE,
        coupled_resonator_hz,
        "coupled to the outer ring: outside the printed demodulation band of 10.2 to 10.4 kHz",
    ),
    Claim("resonator_damping_ratio", "0.01", "1", PAPER_MODEL, resonator_damping_ratio, "Table 1's c_r; we keep it"),
    Claim(
        "load_deflection",
        "5157e6",
        "N/m^1.5",
        PAPER_GEARBOX_TABLE,
        hertz_factor,
        "from geometry with a spherical outer raceway and inner conformity 0.52; we keep the printed one",
    ),
    Claim(
        "contact width",
        "0.2e-3",
        "m",
        "Petersen et al. 2014, section 3.6 (order of magnitude)",
        peak_contact_width,
        "outer race, most loaded ball",
    ),
    Claim(
        "balls within the 40 degree spall",
        "2",
        "1",
        "Petersen et al. 2014, section 5.4",
        lambda rig: math.radians(40.0) / rig.bearing.spacing,
        "on average: one ball at some cage angles, two at others",
    ),
)

FAN_CLAIMS = (
    Claim("bpfo", "76.7", "Hz", PAPER_FAN, bpfo_hz),
    Claim(
        "extent of a 1.2 mm spall",
        "2.6",
        "degrees",
        PAPER_FAN,
        lambda rig: math.degrees(1.2e-3 / rig.bearing.raceway_radius("outer")),
    ),
    Claim("lower mode along y", "0.90e3", "Hz", PAPER_MODES, lambda rig: mode_hz(rig, 2)),
    Claim("upper mode along y", "1.99e3", "Hz", PAPER_MODES, lambda rig: mode_hz(rig, 4)),
    Claim("resonator_frequency", "9.7e3", "Hz", PAPER_FAN, resonator_alone_hz, "the resonator alone"),
    Claim(
        "resonance in the response",
        "9.7e3",
        "Hz",
        PAPER_MODES,
        coupled_resonator_hz,
        "coupled to the outer ring: inside the printed demodulation band of 9.2 to 10.2 kHz",
    ),
    Claim("resonator_damping_ratio", "0.03", "1", PAPER_FAN, resonator_damping_ratio),
    Claim(
        "load_deflection",
        "10.1e9",
        "N/m^1.5",
        PAPER_FAN_TABLE,
        hertz_factor,
        "from geometry with a spherical outer raceway; a groove of 0.52 comes nearer; we keep the printed one",
    ),
)

CWRU_CLAIMS = (
    Claim("bpfo", "3.5848", "orders", CWRU, lambda rig: rig.bearing.bpfo),
    Claim("bpfi", "5.4152", "orders", CWRU, lambda rig: rig.bearing.bpfi),
)

MFPT_CLAIMS = (
    Claim("bpfo", "81.125", "Hz", MFPT, bpfo_hz, "from inches rounded to millimetres"),
    Claim("bpfi", "118.875", "Hz", MFPT, bpfi_hz, "from inches rounded to millimetres"),
)

IMS_CLAIMS = (
    Claim("bpfo", "236.4", "Hz", IMS, bpfo_hz),
    Claim("bpfi", "296.9", "Hz", IMS, bpfi_hz),
)

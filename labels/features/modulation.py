"""Features of the squared envelope spectra: defect families over their floor, in the best of all bands."""

from __future__ import annotations

import numpy as np

from labels.features.analysis import Analysis
from labels.features.families import find_family, fundamentals, sideband_evidence
from labels.features.feature import Feature
from labels.features.lines import Lines
from physics.arrays import Array
from physics.bearing import RACES

SES = "Randall & Antoni 2011, Mech. Syst. Signal Process. 25 (squared envelope spectrum)"
# What is compared between the races, and of that what an inner race may have more of.
COMPARED = ("evidence", "spread", "strength", "depth", "others")
LEADS = ("evidence", "spread", "strength", "others")
STRENGTH_HARMONICS = 3
# Share by which the lines of the shaft may be off from its refined speed.
SHAFT_WITHIN = 0.002


def _counted_in(name: str) -> str:
    """The dimension of one of COMPARED: heights of lines are no evidence."""
    return "ln" if name in ("strength", "depth") else "ln nat"


def _race_rows(race: str, line: str) -> tuple[Feature, ...]:
    return (
        Feature(f"{race}_evidence", "ln nat", f"ln(1 + evidence of {line} and its harmonics 2 to 4), best band.", SES),
        Feature(f"{race}_spread", "ln nat", f"ln(1 + evidence of {line}), the band at the 75 % quantile.", SES),
        Feature(
            f"{race}_others", "ln nat", f"ln(1 + evidence of {line} without its strongest harmonic), best band.", SES
        ),
        Feature(f"{race}_first", "ln nat", f"ln(1 + evidence of the first {line} line alone), best band.", SES),
        Feature(
            f"{race}_sidebands", "ln nat", f"ln(1 + evidence of {line} ± shaft, harmonics 1 and 2), best band.", SES
        ),
        Feature(f"{race}_cage", "ln nat", f"ln(1 + evidence of {line} ± cage, harmonics 1 and 2), best band.", SES),
        Feature(f"{race}_depth", "ln", f"ln of the depth of modulation at the first {line} line, best band.", SES),
        Feature(f"{race}_strength", "ln", f"ln of the mean height of {line} 1 to 3 over the floor, best band.", SES),
        Feature(f"{race}_slip", "%", f"Distance of the {line} line from pure rolling at the refined speed.", SES),
    )


ROWS = (
    *_race_rows("outer", "BPFO"),
    *_race_rows("inner", "BPFI"),
    *(Feature(f"race_{name}", _counted_in(name), f"outer_{name} minus inner_{name}.", SES) for name in COMPARED),
    *(
        Feature(
            f"inner_lead_{name}",
            _counted_in(name),
            f"How far inner_{name} exceeds outer_{name}, or 0: the stiffness of a healthy bearing varies at BPFO only.",
            SES,
        )
        for name in LEADS
    ),
    Feature("ball_evidence", "ln nat", "ln(1 + evidence of twice the ball's spin frequency), best band.", SES),
    Feature("cage_evidence", "ln nat", "ln(1 + evidence of the cage frequency), best band.", SES),
    Feature(
        "shaft_modulation", "ln nat", "ln(1 + evidence of shaft harmonics 1 to 4 in the envelopes), best band.", SES
    ),
    Feature("decoy_evidence", "ln nat", "ln(1 + median evidence at up to eight orders of no bearing part).", SES),
    Feature("largest_decoy", "ln nat", "ln(1 + largest evidence at up to eight orders of no bearing part).", SES),
)


def measure(analysis: Analysis) -> dict[str, float]:
    """Values of ROWS by name."""
    known, shaft = analysis.kinematics, analysis.speed.shaft_hz
    found: dict[str, float] = {}
    for race in RACES:
        found |= {f"{race}_{name}": value for name, value in _race(analysis, race).items()}
    for name in COMPARED:
        found[f"race_{name}"] = found[f"outer_{name}"] - found[f"inner_{name}"]
    found |= {f"inner_lead_{name}": max(-found[f"race_{name}"], 0.0) for name in LEADS}
    turning = find_family(analysis.all_envelope_lines, shaft, SHAFT_WITHIN, shaft)
    decoys = analysis.decoys
    return found | {
        "ball_evidence": _log(analysis.envelope_family(2.0 * known.ball_spin).evidence.max()),
        "cage_evidence": _log(analysis.envelope_family(known.ftf, 3).evidence.max()),
        "shaft_modulation": _log(turning.evidence.max()),
        "decoy_evidence": _log(float(np.median(decoys)) if decoys.size else 0.0),
        "largest_decoy": _log(float(decoys.max()) if decoys.size else 0.0),
    }


def _race(analysis: Analysis, race: str) -> dict[str, float]:
    family, order = (analysis.outer if race == "outer" else analysis.inner), analysis.kinematics.pass_order(race)
    shaft, best = analysis.speed.shaft_hz, int(family.evidence.argmax())
    others = family.parts.sum(axis=1) - family.parts.max(axis=1)
    fundamental = family.fundamental
    return {
        "evidence": _log(family.evidence[best]),
        "spread": _log(np.quantile(family.evidence, 0.75)),
        "others": _log(others.max()),
        "first": _log(family.parts[:, 0].max()),
        "sidebands": _log(sideband_evidence(analysis.all_envelope_lines, fundamental, shaft, shaft).max()),
        "cage": _log(
            sideband_evidence(analysis.envelope_lines, fundamental, analysis.kinematics.ftf * shaft, shaft).max()
        ),
        "depth": _depth(analysis, fundamental),
        "strength": float(np.log(max(line_strength(analysis.envelope_lines, *analysis.race_window(race)), 1e-3))),
        "slip": 100.0 * abs(float(fundamental[best]) / (order * shaft) - 1.0),
    }


def line_strength(lines: Lines, centre: float, tolerance: float) -> float:
    """Mean height of a family's first three lines over the floor, both as amplitudes, in the best band.

    The lines share a fundamental within `tolerance` (a share) of `centre` (Hz); each is read at the resolution of the
    whole record.
    """
    grid = fundamentals(centre, tolerance, 0.5 * lines.step, STRENGTH_HARMONICS, fewest=9, most=1200)
    order = np.arange(1.0, STRENGTH_HARMONICS + 1.0)
    means = lines.means(order[:, None] * grid, np.full(STRENGTH_HARMONICS, lines.narrowest))
    # Means are differences of running sums: rounding can leave one below zero where a band is silent.
    return float(np.sqrt(np.maximum(means, 0.0)).mean(axis=0).max())


def _depth(analysis: Analysis, fundamental: Array) -> float:
    """Largest depth of modulation at a band's own fundamental, ± one component or 1 % of the shaft speed."""
    envelopes = analysis.envelopes
    reach = max(1, int(0.01 * analysis.speed.shaft_hz / envelopes.step))
    centre = np.round(fundamental / envelopes.step).astype(np.int64)
    around = np.clip(centre[:, None] + np.arange(-reach, reach + 1), 0, envelopes.depth.shape[1] - 1)
    return float(np.log(max(np.take_along_axis(envelopes.depth, around, axis=1).max(), 1e-6)))


def _log(nats: float | np.floating) -> float:
    return float(np.log1p(max(float(nats), 0.0)))

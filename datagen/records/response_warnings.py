"""What a reader must know about the simulated response of a record, its background and its recorder, in sentences."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.scenarios.allowed_error import allowed_error
from datagen.scenarios.scenario import Scenario
from labels.variables import AXES
from physics.arrays import Array
from physics.rms import rms
from physics.sensor.recorder import Recorder
from physics.trace import Trace

# Amplification of errors above which a reader is warned: up to it, inputs that agree to 1e-4 give responses that agree
# to half a per cent.
SENSITIVE = 50.0
# Share of samples beyond the range of a recorder above which more than single peaks are cut off.
FEW_CLIPPED = 0.01


def response_warnings(scenario: Scenario, trace: Trace) -> list[str]:
    """Sentences on single points, accuracy and contact changes of the `trace` of a `scenario`; none if all is well."""
    found = (_silence(trace), _chaos(trace), _sensitive(trace), _missed(scenario, trace), _unlocated(trace))
    return [warning for warning in found if warning]


def _silence(trace: Trace) -> str:
    """Says that a response is too small to mean anything; empty if it is not."""
    if not trace.silent:
        return ""
    size = rms(trace.acceleration)
    return f"the response, {size:.1g} m/s² RMS, is no larger than rounding of the contact forces: take it for silence"


def unset_ratio(scenario: Scenario, labels: Mapping[str, Any]) -> str:
    """Says that a background was not scaled to the ratio asked for, as the `labels` show; empty if it was, or if there
    is none."""
    target = scenario.noise_target
    if target is None or not labels["background_layers"]:
        return ""
    label, where = ("snr_db", "") if target.whole else ("snr_band_db", " in that band")
    if not math.isnan(labels[label]):
        return ""
    return (
        f"the {label} asked for, {target.ratio_db:g}, could not be set, as the sensor's signal or the background has "
        f"no power{where}: the background keeps the level of its machine"
    )


def lost_in_steps(recorder: Recorder | None, measured: Array, recorded: NDArray[np.float32]) -> str:
    """Says along which axes nothing of what was `measured` (T, 2) is left in what was `recorded` (T, 2), m/s²; empty if
    there are none."""
    if recorder is None:
        return ""
    lost = [axis for k, axis in enumerate(AXES) if measured[:, k].any() and not recorded[:, k].any()]
    if not lost:
        return ""
    return (
        f"the recorder's step of {recorder.step:.3g} m/s² is too coarse for the signal along {' and '.join(lost)}: "
        "every sample there is 0"
    )


def cut_off(recorder: Recorder | None, clipped: float) -> str:
    """Says that the share `clipped` of the samples lies beyond the range of the `recorder`; empty if few do."""
    if recorder is None or clipped <= FEW_CLIPPED:
        return ""
    return f"{clipped:.2g} of the samples are cut off at the recorder's range of {recorder.full_scale:.3g} m/s²"


def _chaos(trace: Trace) -> str:
    """Says what a chaotic response means for its reader; empty if it is not chaotic."""
    if not trace.chaotic:
        return ""
    return (
        f"bouncing balls multiply errors {trace.sensitivity:.0f} times, and finer steps lead to other responses: it is "
        "chaotic, and its spectra hold but not its single points, unless a smaller error settles them"
    )


def _sensitive(trace: Trace) -> str:
    """Says what it means that the response multiplies errors; empty if it hardly does, or is chaotic."""
    if trace.silent or trace.chaotic or not trace.sensitivity > SENSITIVE:
        return ""
    return (
        f"contacts multiply errors {trace.sensitivity:.0f} times: single points may move if a path of the ball is "
        "computed otherwise by less than a nanometre, so compare them with this program only, and spectra with others"
    )


def _missed(scenario: Scenario, trace: Trace) -> str:
    """Says that the response may be less accurate than was asked for; empty if it is not, or is chaotic or silent."""
    accuracy, least = allowed_error(scenario)
    if trace.silent or trace.chaotic or not trace.error_estimate > accuracy:
        return ""
    size = rms(trace.acceleration)
    allowed = max(accuracy, least / size if size > 0.0 else 0.0)
    if trace.error_estimate <= allowed:
        return ""
    return f"the accuracy asked for, {allowed:.2g}, was not reached: it may be {trace.error_estimate:.2g} off"


def _unlocated(trace: Trace) -> str:
    """Says what changes of contact that could not be located mean for the reader; empty if there are none."""
    if trace.unlocated_changes == 0:
        return ""
    return (
        f"{trace.unlocated_changes} changes of contact could not be located and were taken at the ends of their steps: "
        "release and regain are that much less sure there"
    )

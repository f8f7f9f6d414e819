"""Order, error constant and floor of every method with fixed steps: PYTHONPATH=. python tests/benchmarks/orders.py.

Writes docs/orders.json and the table of docs/accuracy.md, for balls (contacts of exponent 3/2) and rollers (10/9).
Errors of the acceleration (relative RMS) are taken at 1 to 128 steps a sample against exponential_rk4 at 256. Order and
constant are those of the straight line through log error over log step where errors fall: below a hundredth of the
signal, and eight times above the floor, the least of all. The order is also taken from the finer half of these steps,
where errors of higher order have died out.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.versions import in_words, measured_on
from docs.marked_tables import write_marked
from physics.integrators.method_table import MARCHES, METHODS
from physics.outcome import SimulationFailed
from physics.reference_scenes import reference_scene
from physics.request import FixedSteps
from physics.rms import relative_error
from physics.scene import Scene
from physics.simulate import simulate
from tests.physics.smooth import always_in_contact
from tests.physics.variants import with_rollers

ROOT = Path(__file__).resolve().parents[2]
RATE, DURATION = 65536.0, 0.1
ROLLERS_DURATION = 0.4  # s: with rollers errors scatter so much that it takes many passes of G1 to average them
SUBSTEPS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128)
EXACT, FINEST, CHECKED_BY, CHECKED_AT = "exponential_rk4", 256, "runge_kutta4", 192
LARGEST, ABOVE_FLOOR, FEWEST = 1e-2, 8.0, 3
Array = NDArray[np.float64]

SCENES = {
    "smooth": always_in_contact(reference_scene, DURATION),
    "G1": reference_scene("G1", DURATION),
    "F1s": reference_scene("F1s", DURATION),
    "G1, rollers": with_rollers(reference_scene("G1", ROLLERS_DURATION)),
    "F1s, rollers": with_rollers(reference_scene("F1s", DURATION)),
}


def response(scene: Scene, method: str, substeps: int) -> Array:
    """Acceleration (T, 2) with fixed steps."""
    return simulate(scene, RATE, FixedSteps(substeps, method)).acceleration


def measure(scene: Scene, method: str, exact: Array) -> dict[str, object]:
    """Errors by steps a sample; order, constant (error of one step a sample, were it on the line) and floor."""
    errors: dict[int, float] = {}
    for substeps in SUBSTEPS:
        try:
            errors[substeps] = relative_error(response(scene, method, substeps), exact)
        except SimulationFailed:
            continue  # a step that is not stable is refused
    return {"errors": errors, **line_through(errors)}


def line_through(errors: dict[int, float]) -> dict[str, float]:
    """Order, order of the finer half, constant and floor of the errors by steps a sample."""
    floor = min(errors.values())
    first_at_floor = min(count for count, error in errors.items() if error <= ABOVE_FLOOR * floor)
    used = [count for count, error in errors.items() if error < LARGEST and count < first_at_floor]
    used = used if len(used) >= FEWEST else [count for count, error in errors.items() if error < LARGEST]
    finer = used[-max(FEWEST, (len(used) + 1) // 2) :]
    slope, height = np.polyfit(np.log(used), np.log([errors[count] for count in used]), 1)
    of_finer, _ = np.polyfit(np.log(finer), np.log([errors[count] for count in finer]), 1)
    return {
        "order": -float(slope),
        "order_of_finer_half": -float(of_finer),
        "constant": float(np.exp(height)),
        "floor": floor,
    }


def page(report: dict[str, Any]) -> str:
    """One row a method of the report, measured now or read from its file, as Markdown."""
    scenes = report["exact_apart"]  # an older report may have fewer of them
    lines = [
        "| method | order stated | " + " | ".join(f"{name}: order (finer), constant, floor" for name in scenes) + " |",
        "|---" * (2 + len(scenes)) + "|",
    ]
    for method, found in report["methods"].items():
        cells = [
            f"{found[name]['order']:.2f} ({found[name]['order_of_finer_half']:.2f}), "
            f"{found[name]['constant']:.1e}, {found[name]['floor']:.0e}"
            for name in scenes
        ]
        lines.append(f"| {method} | {METHODS[method].order:g} | " + " | ".join(cells) + " |")
    apart = ", ".join(f"{value:.0e} ({name})" for name, value in report["exact_apart"].items())
    checked = f"{EXACT} at {FINEST} and {CHECKED_BY} at {CHECKED_AT} steps a sample are apart by {apart}."
    return "\n".join([*lines, "", checked, "", f"Measured on {in_words(report['made_with'])}."])


def main() -> None:
    """Measure every method on every scene and write both files."""
    exact = {name: response(scene, EXACT, FINEST) for name, scene in SCENES.items()}
    checked = {
        name: relative_error(response(scene, CHECKED_BY, CHECKED_AT), exact[name]) for name, scene in SCENES.items()
    }
    rows = {method: {name: measure(scene, method, exact[name]) for name, scene in SCENES.items()} for method in MARCHES}
    report = {"made_with": measured_on("numpy", "scipy", "numba"), "exact_apart": checked, "methods": rows}
    (ROOT / "docs" / "orders.json").write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
    write_marked(ROOT / "docs" / "accuracy.md", "orders", __file__, page(report))


if __name__ == "__main__":
    main()

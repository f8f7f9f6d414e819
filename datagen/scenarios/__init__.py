"""From a recipe to scenarios: random streams, drawn machines, spalls and runs, and the text that keeps them.

- `sampling`: from a recipe to one `scenario`, in which every number is fixed
- where numbers come from: `streams`, `design` (spread evenly), `turns` (exact counts), `draw` (one attempt), `picker`
- what is drawn: `machine`, with `drawn_rig`, `imperfections`, `chain` and `drawn_background` (a `background`);
  `defect`; `accuracy`, and the `allowed_error` that follows from it
- what cannot be: `feasibility`, `redraw`, and draws as they were `refused`; `intended_kind`: what a redraw keeps;
  `deciders`: the settings that a refusal names
- as text: `scenario_text`, `sampling_text`, `sensor_text`
- what may be absent: `optional`
"""

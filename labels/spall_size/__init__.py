"""How long a spall is, from one record of vibration: event times, their lag, and the arc that goes with it.

- `situation`: what the person asking knows; `size_estimate`: the answer; `estimator`: from the one to the other
- signal: `prewhitening`, `pass_track` (when balls pass), `alignment`, `mean_pass`, `running_energy`, `noise_floor`
- events: `candidates`, `event_shapes`, `event_profiles`, `pair_features`, `evidence` (all pairs of a record)
- choice: `measurement` (which pair), `calibration` (what was learned), `trees` (how it is kept)
- arc: `static_release` (from lag to length), `known_size` (better with a measured spall)
- to compare with: `rules` of the literature, `event_truth` of simulated records
"""

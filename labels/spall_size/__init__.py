"""How long a spall is, from one record of vibration: event times, their lag, and the arc that goes with it.

- `situation`: what the person asking knows; `size_estimate`: the answer; `estimator`: from the one to the other
- signal: `prewhitening`, `pass_track` (when balls pass), `alignment`, `mean_pass`, `running_energy`, `noise_floor`
- events: `candidates`, `pairs` of them, `evidence` (all pairs of a record), `leading` (the best of them)
- columns that describe a pair, joined by name in `table`: of all pairs `pair_record`, `pair_levels`, `pair_likeness`,
  `pair_motion`, `event_shapes`; of leading ones `event_profiles`, `pair_rivals`, `pair_length`, `pair_load`; of the one
  taken for the events `choice`
- choice: `measurement` (which pair), `calibration` (what was learned), `trees` (how it is kept)
- arc: `static_release` (from lag to length), `known_size` (better with a measured spall)
- to compare with: `rules` of the literature, `event_truth` of simulated records
"""

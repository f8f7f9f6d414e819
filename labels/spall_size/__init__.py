"""How long a spall is, from one record of vibration: event times, their lag, and the arc that goes with it.

- `situation`: what the person asking knows; `size_estimate`: the answer; `estimator`: from the one to the other
- `signal/`: from the record to its mean pass
- events: `candidates`, `pairs` of them, `evidence` (all pairs of a record, by way of `gathering`), `leading`
  (the best of them)
- `columns/`: what describes a pair, joined by name in `columns.table`
- choice: `measurement` (which pair), `calibration` (what was learned), `trees` (how it is kept)
- arc: `static_release` (from lag to length), `known_size` (better with a measured spall)
- to compare with: `rules` of the literature, `event_truth` of simulated records
"""

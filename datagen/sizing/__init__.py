"""Spall sizes of whole corpora: estimated, scored, drawn, and the estimator's calibration fitted.

- `sized_records`: records as an estimator sees them, from `stored_record` and `stated_situation`
- `estimators`: ours, and a `user_estimator`
- `corpus_run`: the `size_scores` of a corpus, as a `size_request` asks for them, scored `in_blocks`; `comparison` with
  the truth makes a `scored_record` of each
- `aggregation`: all of them together, as a `size_summary`, made of `figures` and `error_tables` from `record_errors`,
  with `bearing_intervals`
- `stated_sizes`: recordings by what their publishers state; `known_sizes`: with a measured spall of the machine
- `report_files`, `flat_rows`: what is written
- `fit`: the calibration, from `training_rows` by way of `trial_columns`, in `fit_stages`, each a `committee`;
  `cross_fit`: what it says of bearings not fitted to; `fit_limits`: doubt and intervals
"""

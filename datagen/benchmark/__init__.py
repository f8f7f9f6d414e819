"""Benchmarks of classifiers: features of corpora, training, scoring, reports.

- `options`: what was asked; `request`: that checked, as a `plan`
- `classify`: the run from training to report, in two halves, `run_learning` and `run_scoring`
- `fitness`: whether a record can be judged
- `rows`: the table that is learned from; `reading_policy`, `record_rows`, `corpus_rows`: how records become rows of
  features; `feature_table`: these for people; `windows`: raw pieces for other people's estimators
- `training`, `trained` (what came of it, as a file), `learning` (the curve), `importance`
- `impulse_signal`, `impulse_training`: learning without physics
- `machines`: no record is scored of a machine that was learned from; `answers`: what an estimator says, checked
- `verdicts`: one answer a record; `predictions`: these as a table
- `summary`: scores, which `model_scores` holds; `results`: all that a run gives; `log_line`: what the log beside each
  scored corpus says of it
"""

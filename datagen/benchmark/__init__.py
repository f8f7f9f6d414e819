"""Benchmarks of classifiers: features of corpora, training, scoring, reports.

- `options`: what was asked for; `request`: checks it and makes a `plan` of it
- `classify`: the run from training to report, in two halves, `run_learning` and `run_scoring`
- `fitness`: whether a record can be judged; `truth`: what it really is, for training and scoring
- `rows`: the table that is learned from; `reading_policy`, `record_rows`, `corpus_rows`: how records become rows of
  features; `feature_table`: these rows for people; `windows`: raw pieces for users' own estimators
- `training_source`: what can be learned from: a corpus, `kept_rows`, which come with the program, or impulse trains
- `training`, `trained` (the result, as a file), `learning_curve`, `importance` (of features)
- `impulse_signal`, `impulse_training`: the rival training set, made without contact physics;
  `log_uniform`: how levels are drawn
- `machines`: keeps records of machines that were learned from out of the scores; `chosen`: the records that are judged
- `answers`: checks what an estimator says
- `verdicts`: one answer per record; `predictions`: these as a table
- `summary`: computes the scores, which `model_scores` holds; `results`: all that a run returns; `log_line`: what the
  log beside each scored corpus says about it
"""

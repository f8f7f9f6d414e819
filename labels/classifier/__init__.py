"""The classifier of spalls, learned from rows of the feature table, and the rule that it is measured against.

- `classes`: the classes, and the location and condition that follow from their probabilities
- `spall_classifier`: the baseline; it asks three questions, each a calibrated `stage`
- `learners`: forest, logistic regression and boosting; `signed_logistic` and `blend` (the mean of several `log_odds`)
  are parts of them
- `alarm`: the probability at which a spall is called
- `rule`: the yardstick without learning
- `votes`: one answer a record, of all its windows and axes
- `liveness`: whether a record shows a running machine at all
- `scores`, `reliability`: how good answers are, with intervals
"""

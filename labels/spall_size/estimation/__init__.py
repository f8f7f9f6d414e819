"""From a record and what is known of its machine to the size of its spall.

- `first_passes`: how much of a record is looked at
- `gathering`: the evidence of a record; `measurement`: which of its pairs is taken for the events
- `calibration`: what was learned, `trees`: how it is kept
- `estimator`: the size; `rules`: those of the literature, to compare with
"""

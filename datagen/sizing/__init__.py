"""Spall sizes of whole corpora: estimated, scored, drawn, and the estimator's calibration fitted."""

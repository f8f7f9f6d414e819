"""How wrong the shaft speeds may be that classifiers and size estimators are told in training."""

SPEED_ERROR = 0.02  # largest relative error

"""How wrong the shaft speed may be that classifiers and size estimators are given.

A module of its own, as commands that only show it in their help must not load more.
"""

# Largest relative error of the shaft speeds that classifiers and size estimators are given in training. The true speed
# is 2.04 % above one given 2 % too low, and features look for it within MEASURED_WITHIN of the one given
# (labels/features/kinematics.py): so that is a little wider, and a test asserts it.
SPEED_ERROR = 0.02

"""What the benchmark of classifiers and that of size estimators share.

- `known`: which labels of a record they may be told; `stated_speed`: how wrong the speed among these may be
- `splits`: the split that is asked for, and the one that is left to score
- `user_code`: estimators that users bring
- `scored_runs`: the log of every run that scores recordings
"""

"""What classifiers and size estimators are judged alike by.

- `known`: what of a record's labels they may be told; `stated_speed`: how wrong the speed may be
- `truth`: what a record really is, for training and scoring
- `splits`: the split that is asked for
- `user_code`: estimators that users bring
- `scored_runs`: the log of every run that scores recordings
"""

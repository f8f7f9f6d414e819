"""Where the events of a pass may be.

- `candidates`: places in the mean pass; `pairs`: every two of them
- `evidence`: all that a record shows, its pairs included; `leading`: the best of the pairs
"""

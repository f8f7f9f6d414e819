"""Balls between their races.

- `track`: where balls are and what they run on, as functions of time; `waves`: the table of the waviness
- `forces`: what presses them; `contact_set`: which of them touch
- `turning` (cosine and sine) and `power`: plain arithmetic that the compiler puts into vectors
"""

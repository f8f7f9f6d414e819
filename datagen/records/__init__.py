"""From a scenario to one record: simulated, given its background, described by labels and exact truth.

- `record`: the whole; `layers`: its background; `response_warnings`: what a reader must know about its simulation
- `stiffness_axis`, `profile_grid`: where stiffness and depth are stored
"""

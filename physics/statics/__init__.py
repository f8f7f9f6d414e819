"""The bearing at rest at every instant.

`rest` finds the place of the shaft, `load_distribution` what each ball carries, `stiffness` how the bearing resists,
`stiffness_series` the same over a record, solved only where it is not told by its neighbours.
"""

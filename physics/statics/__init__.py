"""The bearing at rest at every instant.

- `rest`: the place of the shaft; `load_distribution`: what each ball carries there
- `ball_load`: the same of chosen balls at chosen instants
- `stiffness`: how the bearing resists; `stiffness_series`: the same over a record, solved at as few
  instants as will do
"""

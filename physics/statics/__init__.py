"""The bearing at rest at every instant.

- `rest`: the place of the shaft at one instant; `successive_rest`: at one after another
- `load_distribution`: what each ball carries there
- `ball_load`: the same of chosen balls at chosen instants
- `stiffness`: how the bearing resists; `rest_series`: places and stiffness over a record, solved at as few instants as
  will do; `stiffness_series`: what a record has of it
"""

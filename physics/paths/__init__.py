"""Where a spall leads the centre of a ball.

- `profile`: the front door
- `spall_surface`, `roughness`: the surface, a path as it is or after a ball has rolled over it
- `rolling`: where the centre of that ball runs; `held_ball`: the ball, and what holds it; `corners`: where it changes
  bumps; `path_nodes`: its smooth branches, and the nodes that these need between those a step apart
- `depth_path`: either kind of path as cubic pieces between edges
- `passages`: when balls come by
"""

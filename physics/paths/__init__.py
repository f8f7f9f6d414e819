"""Where a spall leads the centre of a ball.

`profile` is the front door. A surface (`spall_surface`, `roughness`) is a path as it is or after a ball has rolled over
it (`rolling`, `held_ball`); either becomes cubic pieces between edges (`depth_path`). `passages` and `kinks` say when
balls come by.
"""

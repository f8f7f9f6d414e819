"""Bearing physics: geometry, contact, statics, motion. Reads no file and knows no other package of this project.

[P14] in docstrings is Petersen, Howard, Sawalhi, Moazen Ahmadi and Singh, Mechanical Systems and Signal Processing,
2014 (README, Sources).

What a machine is, put together in a `scene`:

- `bearing`, with `hertz` (how stiff and how wide a contact is), `rating` (static load rating) and `orders` (how often
  balls pass)
- `rig`, `spall`, `imperfections`, `operation`, `cage` (with `crossing`: when a cage comes by an angle)
- `catalog/`: published bearings and rigs; `reference_scenes`: the named scenes of the paper's two rigs

What comes of it, from the front door inwards:

- `simulate`: a scene in, a `trace` out, or an `outcome` that says what failed; `request`: how it is wanted
- `response/`: the response to a stated accuracy; `ladder/`: the simpler models
- `integrators/`: one numerical method, one file; `integrators/modal/` is the default
- `motion`, `modes`: the equations of motion around the contacts, and what they are when linear
- `contact/`: the forces between balls and races; `paths/`: where a spall leads the centre of a ball
- `statics/`: where the shaft rests, which ball carries what, how stiff the bearing is
- `contact_events`: release and regain of every ball pass; `validity`: where the model ends
- `sensor/`, `backgrounds/`: from the bearing to the recording

What all of them use:

- `assembly`: from a scene to the arrays and NamedTuples that kernels read
- `arrays`: names of array types; `words`: those of scenes and results, for packages that need no more than these
- `_jit/`: compiles kernels; `warming` does so early; `compiled`: what other packages need of the compiler
- `checks` (a value refused) and `spelling` (the name that was meant), `angular_speed` (rad/s in rpm and Hz), `rms`,
  `recursive_filter`
"""

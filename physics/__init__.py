"""Bearing physics: geometry, contact, statics, motion. Reads no file and knows no other package of this project.

What a machine is: `bearing`, `hertz`, `rating`, `rig`, `spall`, `operation`, `imperfections`, `cage`, put together in a
`scene`; published ones are in `catalog/`. What comes of it, from the front door `simulate` inwards:

- `simulate`: a scene in, a `trace` out, or an `outcome` that says what failed; `validity` says where the model ends
- `response/`: the response to a stated accuracy; `ladder/`: the simpler models
- `integrators/`: one numerical method, one file; `integrators/modal/` is the default
- `motion`, `modes`: the equations of motion around the contacts, and what they are when linear
- `contact/`: the forces between balls and races; `paths/`: where a spall leads the centre of a ball
- `statics/`: where the shaft rests, which ball carries what, how stiff the bearing is
- `sensor/`, `backgrounds/`: from the bearing to the recording

Kernels read arrays and NamedTuples that `assembly` makes of a scene; `_jit` compiles them and `warming` does so early.
Other packages compile kernels of theirs by `compiled`.
"""

"""The response of a scene, by way of one or several marches.

- by a method of fixed steps: `single_march` (once), `fixed_steps` (how many a sample), `stability` (how long they are)
- by the default method: `modal_case` (a march that can be gone on with), `adaptive` (to the accuracy that is `asked`
  for), with `goal` (tolerance and error) and `attempts` (made again, or confirmed by a finer one)
- `periodic`: only until the response repeats itself; `lead_in`: begun before the record
- `silence`: what is too small to be more than rounding
- `kinks`: known instants at which steps have to end; `change_log`: room for changes of contact; `march_output`: what
  a march writes into, and the trace that comes of it
- `oversampling`: how finely to sample a response; `resampling`: other samples of what came out
- `part`: made again until a part of it is exact enough: what comes behind a lead-in, or what is left at a lower rate
  (`lowered`); `finer_paths`: made again over paths of balls in finer cells, for a small accuracy
"""

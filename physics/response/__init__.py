"""The response of a scene, by way of one or several marches.

`march` marches once with a given method and step, `fixed_steps` chooses how many a sample. `modal_case` is a march by
the default method that can be gone on with; `adaptive` goes on with it to a stated accuracy, `periodic` only until the
response repeats itself. `stability` bounds explicit steps, `kinks` knows beforehand where steps have to end,
`oversampling` says how finely to sample a response, and `resampling` gives other samples of what came out.
"""

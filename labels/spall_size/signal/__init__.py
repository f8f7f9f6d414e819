"""From a record to its mean pass.

- `prewhitening`: the ringing of the machine taken away; `noise_floor`: how much of the record is white noise
- `pass_track`: when balls pass; `alignment`: passes lined up on their strongest event
- `mean_pass`: their mean; `running_energy`: the energy of any stretch of it
- `divisors`: levels of silent stretches, to divide by
"""

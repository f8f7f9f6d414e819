"""From a record to its mean pass.

`prewhitening`, `pass_track` (when balls pass), `alignment`, `mean_pass`, `running_energy`, `noise_floor`
"""

"""What a sensor shows besides the bearing, in m/s²: one layer, one file.

- noise: `white` (sensor and amplifier), `pink` (rises towards low frequencies)
- lines: `shaft_harmonics`, `gear_mesh`, `mains_hum`, all of them sums of `tones`
- `impulses`: knocks that ring the machine's resonances
- `recording`: a stretch of somebody's recording of a healthy machine
"""

"""The feature table: numbers that a vibration analyst would recognise, from acceleration, geometry and shaft speed.

- `jumps`, `drift`, `glitches`, `shocks`: a bias that jumps or wanders, what a recorder wrote wrongly, blows from
  outside: taken out first, by `mending`; `whole_turns` cuts a signal into turns of the shaft
- `conditioning`: a signal's spectrum, raw and flattened; `envelopes`: envelope spectra of a tree of bands
- `turning`: all of that over the angle turned, for speeds that change
- `combs`: lines of another shaft's knocks, taken out; `foreign_combs` and `race_combs` find them
- `lines`: spectra read between their components; `known_lines`: those of shaft and mains, left out
- `families`: evidence of lines with harmonics and sidebands; `kinematics`: where a bearing has them
- `speed`: the shaft's speed refined; `analysis`: all of these of one record, computed once
- `waveform`, `modulation`, `orders`: groups of features; `table`: all of them, by name; `feature`: what a row says
- `signal_features`: all of that for one array
"""

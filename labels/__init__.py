"""Labels: their schema, the truth they hold, and what is estimated from signals. Arrays in, arrays out.

- `schema`, `variables`: the tables of labels and arrays that every corpus has; `vocabulary`: the same in others' words
- `description`: labels of a scene; `truth`, `load_dips`: what each ball pass truly did, and when
- `band`, `envelope`, `spectrum`, `spectrogram`, `density`, `window`, `noise`: signals as an analyst looks at them
- `band_tree`: the bands that are searched; `kurtogram`: the one of them in which a signal is most impulsive;
  `squared_envelope`: what both are made of
- `dead_sensor`: whether it is that of a sensor at all; `filling`: what stands in for samples that are missing or wrong
- `event_scores`: found events against true ones; `interval`: an estimated number with the interval around it
- `features/`: the feature table of a record; `classifier/`: what is learned from it; `spall_size/`: sizes from signals
"""

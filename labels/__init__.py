"""Labels: their schema, the truth they hold, and what is estimated from signals. Arrays in, arrays out.

- `schema`, `variables`: the tables of labels and arrays that every corpus has; `vocabulary`: the same in others' words
- `description`: labels of a scene; `truth`, `load_dips`: what each ball pass truly did, and when
- `envelope`, `spectrum`, `spectrogram`, `density`, `noise`: signals as an analyst looks at them
- `event_scores`: found events against true ones
- `features/`: the feature table of a record; `classifier/`: what is learned from it; `spall_size/`: sizes from signals
"""

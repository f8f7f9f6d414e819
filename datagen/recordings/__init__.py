"""Recordings of real machines, brought by a SPEC into the same schema as simulated records.

How records come to be: a SPEC's parts become requests, a file and one of its channels each (`listing`); every
request is read (`recorded`) and planned (`import_plan`), and nothing is written before all have been; then they are
read again, shard by shard, into a folder beside the one asked for, which takes its place once whole (`importing`).

- `spec_files`: where a SPEC is found; `spec`: the whole; `settings`: what it says of a recording; `values`: its numbers
- `listing`: which records it asks for; `part_files`: in which files, with `root`, `file_names` and `label_table`
- `opened_files`: each opened once, as a `source`; `recorded`: its records; `doubts`: what is odd about them;
  `unchanged`: files that must not change during an import
- `sample_times`: the sampling rate; `stated_rate`: whether the file tells another
- `shaft_speed`: the speed, with the `pulse_times` and `pulses` of a tach
- `description`: labels; `dataset`: the records as a shard holds them
- `importing`: the whole import, from an `import_plan` to a folder that appears whole (`staging`)
"""

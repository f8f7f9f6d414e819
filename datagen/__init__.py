"""From a recipe to labelled files: drawing, workers, shards, corpora and the command line.

- what a person writes: `settings/` (TOML and its mistakes), `distributions/`, `recipes/`
- what comes of it: `scenarios/` (every number fixed), `records/` (simulated and labelled)
- on the disk: `files/` (of any kind), `corpus_files/` (shards, index, manifest), `corpus` (reads these),
  `runs/` (workers)
- real machines: `formats/` (files by format), `recordings/` (brought into the same schema)
- judged: `inspection/` (is a corpus sound?), `benchmark/` (classifiers), `sizing/` (spall sizes), `judging/` (shared by
  the last two), `charts/` (speed against accuracy)
- shown: `drawing/`, `paper/`, `cards/`
- `commands/`, joined by `cli`, which `__main__` runs
- what all of them use: `errors` (bad input, refused in one line), `counts` (numbers as people read them), `progress`
  (how far a command has got), `exits` (exit codes), `garbage` (a collector that runs rarely), `freed_memory` (kept for
  the next arrays), `processes` (workers that never outlive their parent), `versions`
"""

"""One file per command. Heavy packages are imported inside the commands, so that `--help` answers at once.

- corpora: `generate`, `import_recordings`, `check`, `info`, `preview`, `report`
- scores: `features`, `classify`, `size`, `chart`, `paper`
- reference: `catalog`, `schema`
- what they share: `program` (how a command ends and complains), `usage` (command lines that cannot be read),
  `grouped` (options that belong together), `termination` (SIGTERM), `tables` and `size_tables` (results on a terminal),
  `progress_display` (how far a command has got)
"""

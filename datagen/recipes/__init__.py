"""What a person says of a corpus: a recipe, checked; the same recipe always gives the same corpus.

- `recipe_files`: where it is found; `recipe`: the whole; `recipe_schema`: what it may hold, for editors
- its tables: `machine_settings`, `imperfection_settings`, `operation_settings`, `defect_settings`, `chain_settings`,
  `background_settings`, `signal_settings`, `accuracy_settings`, `store_settings`, `split_settings`; kinds of number
  that several of them share, and ranges that recordings share with them: `quantities`
- files that it names: `profile_table` (a measured spall), `recording_settings` and `recording_file` (a background)
- `sampling_limits`: frequencies that are allowed; `record_order`: in which order its parts come

Kinds of setting and messages about mistakes are in datagen/settings, what can be drawn in datagen/distributions.
"""

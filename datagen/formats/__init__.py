"""Files of recordings: one file a format, each gives arrays by name.

- `reading`: opens a file by its format; `arrays`: its arrays, and the choice of one
- `mat_file`, `numpy_file`, `netcdf_file`, `wav_file`, `csv_file` with its `csv_layout` and, for messages, `csv_hints`
- `placeholders`: what stands in braces in a SPEC's texts
"""

"""Records in files: shards, their index and their manifest.

- `format`: records as one dataset; `shard`: that as a file; `reading`, `open_shards`, `signal`: read again
- `index`: all labels, one row a record; `manifest`: what a corpus was made from
- `json_values`: values of JSON files, which anybody may have edited, checked

Whether they are sound is checked in datagen/inspection.
"""

"""Records in files: shards, their index and manifest, and the check of all of them."""

"""Making a corpus: the plan of its shards, the workers, crashes and resumption."""

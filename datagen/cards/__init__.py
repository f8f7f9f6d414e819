"""The card of a corpus: what it holds and how it came about, written from its own files and from nothing else."""

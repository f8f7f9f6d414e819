"""From a recipe to labelled files: drawing, workers, shards, corpora and the command line."""

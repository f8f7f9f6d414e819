"""Making a corpus: the plan of its shards, the workers, crashes and resumption.

- `generate`: from a recipe to a corpus; `run`: one run over its folder; `earlier`: what runs before left there,
  and `changes` of the recipe since; `finished`: the shards that are done
- `requirements`: what can never be made is refused; `plan`: which record goes into which shard;
  `redraws`: how often it drew again; `rates` that are too low; `unseen_passes` of spalls
- `workers`, and the `task` of each
"""

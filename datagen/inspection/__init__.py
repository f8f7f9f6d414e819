"""Looking a corpus over: what it holds, whether its files are sound, and whether records come out the same again.

- `info`: what it holds, beside what was `asked_for`; `check`: whether it is what it says
- `recipe_check`: the same of a recipe of which nothing is made yet
- `manifest_check`, `conformity`: the same of a manifest and of a shard; `remaking`: records made again
- `remedy`: how to mend or finish it
"""

"""Looking a corpus over: what it holds, whether its files are sound, and whether records come out the same again.

- `info`: what it holds, beside what was `asked_for`
- `check`: whether it is what it says, by what its `corpus_parts` say of each other (`manifest_check`) and by a
  `shard_check` of each shard (`conformity`: to the format); `remaking`: records made again
- `findings`: what each of these found wrong; `remedy`: how to mend or finish it
- `recipe_check`: the same of a recipe of which nothing is made yet
"""

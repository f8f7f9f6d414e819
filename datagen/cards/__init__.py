"""The card of a corpus: what it holds and how it came about, written from its own files and from nothing else.

- `corpus_report`: writes all of it; `facts`: what it says; `card`: that as Markdown
- `origin_text`: recipe or SPEC, as `toml_text`
- `croissant`: metadata for search engines; `vocabulary_table`: labels in others' words
"""

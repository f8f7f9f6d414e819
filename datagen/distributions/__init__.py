"""Values that are drawn: what a recipe can write in place of a number or a word.

- `distribution`: what each of them is; `kinds`: all by name
- `ranges`: of numbers over a range; `choices`: of listed values, drawn freely or by turns
"""

"""Values that are drawn: what a recipe can write in place of a number or a word."""

"""From a recipe to scenarios: random streams, drawn machines, spalls and runs, and the text that keeps them."""

"""Models of one scene from the cheapest to the full one: one model, one file, each with its known range."""

"""Looking a corpus over: what it holds, whether its files are sound, and whether records come out the same again."""

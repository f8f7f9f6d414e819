"""What a person says of a corpus: the kinds of setting, their distributions, and messages about mistakes."""

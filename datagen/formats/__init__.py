"""One file a file format: each gives the arrays of a file by name."""

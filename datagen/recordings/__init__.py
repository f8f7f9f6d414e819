"""Recordings of real machines, brought by a SPEC into the same schema as simulated records."""

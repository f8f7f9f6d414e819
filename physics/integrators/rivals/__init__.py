"""Solvers as others would pick or write them: measured beside the methods of this package, no record is made by them."""

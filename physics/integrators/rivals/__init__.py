"""Solvers as others would pick or write them: measured beside this package's methods, no record is made by them."""

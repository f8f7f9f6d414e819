"""Numerical methods for the equations of motion: one method, one file."""

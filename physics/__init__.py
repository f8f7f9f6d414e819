"""Bearing physics: geometry, contact, statics, motion. Reads no file and knows no other package of this project."""

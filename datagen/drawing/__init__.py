"""Panels of the preview and of the pictures in the documentation."""

"""Settings in TOML, of recipes and of import SPECs: tables with ranges, and clear messages about what is wrong.

`table`: kinds of setting; `docstrings`: what is said of each; `toml_file`: a file read; `toml_lines`, `problems`: which
line is wrong, and what with it.
"""

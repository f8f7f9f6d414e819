"""Settings in TOML, of recipes and of import SPECs: tables with ranges, and clear messages about what is wrong."""

"""`spallgen catalog`: the bearings and rigs that recipes can name."""

from __future__ import annotations

from datagen.commands.program import JsonFile, command, show_tables, write_json


@command("spallgen catalog")
def catalog(json_file: JsonFile = None) -> None:
    """List the bearings and rigs that recipes can name, with the source of their numbers."""
    from datagen.commands.tables import catalog_data, catalog_tables

    write_json(json_file, catalog_data())
    show_tables(catalog_tables())

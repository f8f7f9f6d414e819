"""The page of all keys of a recipe is what its script makes of the settings."""

from pathlib import Path

from datagen.recipes.recipe_schema import recipe_schema

PAGE = (Path(__file__).parents[3] / "docs" / "recipe_keys.md").read_text(encoding="utf-8")


def test_the_page_is_what_the_script_writes(load_script):
    assert load_script("make_recipe_keys").page() == PAGE, "run: python docs/make_recipe_keys.py"


def test_every_key_of_the_schema_is_on_the_page_with_its_meaning():
    schema = recipe_schema()
    for table in (schema, *schema["$defs"].values()):
        for name, key in table.get("properties", {}).items():
            rows = [line for line in PAGE.splitlines() if line.startswith(f"| `{name}` |")]
            assert any(" ".join(key["description"].split()) in row for row in rows), name

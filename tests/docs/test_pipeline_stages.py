"""The profile of the pipeline adds up functions by name: a name that is gone would count as no time at all."""

import ast

from marked_tables import ROOT

from tests.benchmarks.pipeline import STAGES


def test_every_function_of_a_stage_is_one_of_the_packages():
    known = [
        node.name
        for package in ("physics", "labels", "datagen")
        for path in (ROOT / package).rglob("*.py")
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.FunctionDef)
    ]
    assert {name: known.count(name) for names in STAGES.values() for name in names} == {
        name: 1 for names in STAGES.values() for name in names
    }

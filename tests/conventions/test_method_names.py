"""The name of a method stands in its file, its YAML, its docs and its tests, and nowhere else."""

import ast

from source import files

from codriving.config.choices import choices

STILL_NAME = {"llm"}
"""Templates are called after the method that asks; none are added."""


def test_methods_are_named_by_themselves_alone() -> None:
    names = set(choices("method")) - {"codriving"}
    found = {
        file.room
        for file in files()
        if file.room != "methods"
        for node in file.nodes
        if isinstance(node, ast.Constant) and node.value in names
    }
    assert found <= STILL_NAME

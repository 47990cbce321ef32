"""The source code of a demo, as a lesson shows it."""

from __future__ import annotations

import ast

from studio.course.demos import DEMOS, code_of


def test_every_demo_shows_code_that_has_its_node_or_runs_it():
    for demo in DEMOS:
        files = code_of(demo.name)
        first = next(iter(files.values()))
        names = {one.name for one in ast.walk(ast.parse(first)) if isinstance(one, ast.ClassDef)}
        assert names, demo.name


def test_a_demo_of_several_files_shows_those_that_it_imports_after_its_own():
    assert list(code_of("turtlesim_node")) == [
        "turtlesim_node.py",
        "turtlesim/endpoints.py",
        "turtlesim/turtles.py",
    ]
    rover = list(code_of("rover"))
    assert rover[0] == "rover/node.py"
    assert "rover/__init__.py" not in rover

"""Changes of a Python file: one more import."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from studio.packages.sources.python_file import PythonFile
    from studio.problems import Replacement


def import_added(python: PythonFile, line: str) -> Replacement:
    """Put an import before the first one of the file, or behind its docstring."""
    tree = python.tree
    source = python.source
    body = tree.body if tree else []
    later = [
        one
        for one in body
        if not (isinstance(one, ast.Expr) and isinstance(one.value, ast.Constant))
        and not (isinstance(one, ast.ImportFrom) and one.module == "__future__")
    ]
    if not later:
        return source.put_in(len(source.data), f"{source.line_break}{line}{source.line_break}")
    first = later[0]
    decorators = getattr(first, "decorator_list", [])
    at = source.line_start(python.span(decorators[0] if decorators else first)[0])
    gap = "" if isinstance(first, ast.Import | ast.ImportFrom) else source.line_break * 2
    return source.put_in(at, f"{line}{source.line_break}{gap}")

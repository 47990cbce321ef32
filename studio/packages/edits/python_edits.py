"""Changes of a Python file: one more import."""

from __future__ import annotations

import ast
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from studio.packages.sources.python_file import PythonFile
    from studio.problems import Replacement


def import_added(python: PythonFile, line: str) -> Replacement:
    """Put an import before the first one of the file, or behind its docstring."""
    source = python.source
    eol = source.line_break
    body = python.tree.body if python.tree else []
    first = next((one for one in body if not _stays_first(one)), None)
    if first is None:
        return source.put_in(len(source.data), f"{eol}{line}{eol}")
    decorators = getattr(first, "decorator_list", [])
    at = source.line_start(python.span(decorators[0] if decorators else first)[0])
    return source.put_in(at, f"{line}{eol}{eol * _lines_between(line, first)}")


def _stays_first(node: ast.stmt) -> bool:
    """Whether it is the docstring, or an import of the future."""
    if isinstance(node, ast.ImportFrom):
        return node.module == "__future__"
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


def _lines_between(line: str, first: ast.stmt) -> int:
    """Count the blank lines behind an import: Python's own modules stand apart from others."""
    match first:
        case ast.Import(names=[alias, *_]):
            module = alias.name
        case ast.ImportFrom(module=named):
            module = named or ""
        case _:
            return 2
    return int(_is_pythons(line.split()[1]) != _is_pythons(module))


def _is_pythons(module: str) -> bool:
    return module.partition(".")[0] in sys.stdlib_module_names

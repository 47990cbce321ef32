# pyright: basic
"""Writes down which files of the studio run, while a number tells what for.

A copy of this file named `sitecustomize.py`, first on PYTHONPATH, puts it into a studio and its
workers. Every function and every loop of `studio` then begins with a call that writes the file's
name down, once for each step; the step is the byte that is mapped from `STUDIO_WALK/step`. Other
ways to watch Python do not see the threads that Zenoh starts.
"""

import ast
import builtins
import mmap
import os
import sys
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from pathlib import Path
from types import CodeType

FOLDER = Path(os.environ["STUDIO_WALK"])
_FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
_LOOPS = (ast.For, ast.AsyncFor, ast.While)

with (FOLDER / "step").open("r+b") as _file:
    _step = mmap.mmap(_file.fileno(), 1)
_out = (FOLDER / f"{os.getpid()}.walk").open("a", buffering=1)
_seen: set[tuple[int, str]] = set()


def _note(file: str) -> None:
    key = _step[0], file
    if key[0] and key not in _seen:
        _seen.add(key)
        _out.write(f"{key[0]} {file}\n")


class _Noting(ast.NodeTransformer):
    """Puts the call first into every body."""

    def __init__(self, file: str) -> None:
        self._call = ast.parse(f"__studio_walk__({file!r})").body[0]

    def generic_visit(self, node: ast.AST) -> ast.AST:
        super().generic_visit(node)
        if isinstance(node, (*_FUNCTIONS, *_LOOPS)):
            has_docstring = isinstance(node, _FUNCTIONS) and ast.get_docstring(node) is not None
            node.body.insert(1 if has_docstring else 0, self._call)
        elif isinstance(node, ast.Lambda):
            both = ast.Tuple([self._call.value, node.body], ast.Load())  # type: ignore[attr-defined]
            node.body = ast.Subscript(both, ast.Constant(1), ast.Load())
        return node


class _Loader(SourceFileLoader):
    def get_code(self, fullname: str) -> CodeType:
        path = self.get_filename(fullname)
        tree = _Noting(path).visit(ast.parse(self.get_data(path)))
        return compile(ast.fix_missing_locations(tree), path, "exec", dont_inherit=True)


class _Finder(MetaPathFinder):
    def find_spec(self, fullname: str, path=None, target=None) -> ModuleSpec | None:  # noqa: ANN001
        if fullname.partition(".")[0] != "studio":
            return None
        spec = PathFinder.find_spec(fullname, path, target)
        if spec is not None and type(spec.loader) is SourceFileLoader:
            spec.loader = _Loader(fullname, spec.loader.path)
        return spec


builtins.__studio_walk__ = _note  # type: ignore[attr-defined]
sys.meta_path.insert(0, _Finder())

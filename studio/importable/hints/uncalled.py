"""A file that defines `main` and does not call it: it ends at once, and nothing says why."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import Final

from studio.importable.hints.said import place_of

_SIZE_MAX: Final = 1_000_000


def uncalled_hint(file: str) -> str | None:
    """Return a sentence about a `main` that nothing in its file uses; None: there is none.

    Args:
        file: A program that ended without an error and made no node.
    """
    try:
        with Path(file).open("rb") as text:
            tree = ast.parse(text.read(_SIZE_MAX))
    except (OSError, SyntaxError, ValueError, RecursionError):
        return None
    mains = [
        one
        for one in tree.body
        if isinstance(one, ast.FunctionDef | ast.AsyncFunctionDef) and one.name == "main"
    ]
    if not mains:
        return None
    for statement in tree.body:
        if statement not in mains and any(_uses_main(one) for one in ast.walk(statement)):
            return _not_asked(statement, file)
    return (
        f"{place_of(file, mains[0].lineno)}: main is defined and never called: add "
        'if __name__ == "__main__": main() at the end.'
    )


def _uses_main(node: ast.AST) -> bool:
    return isinstance(node, ast.Name) and node.id == "main" and isinstance(node.ctx, ast.Load)


def _not_asked(statement: ast.stmt, file: str) -> str | None:
    """Return what is wrong with `if __name__ == "main":`, whose call was not reached."""
    test = statement.test if isinstance(statement, ast.If) else None
    if not (isinstance(test, ast.Compare) and isinstance(test.left, ast.Name)):
        return None
    if test.left.id != "__name__" or any(
        isinstance(one, ast.Constant) and one.value == "__main__" for one in test.comparators
    ):
        return None
    return (
        f'{place_of(file, statement.lineno)}: main is not called, for __name__ is "__main__" '
        'there: write if __name__ == "__main__": main().'
    )

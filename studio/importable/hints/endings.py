"""What a program ended with: the error that was not caught, or a `main` that nobody called."""

from __future__ import annotations

import ast
import traceback
from typing import Any

from studio.importable.hints.said import place_of, tree_of
from studio.ros.node.service import Service


def ending_hint(error: BaseException) -> str | None:
    """Return a sentence about the mistake behind an error; None: nothing is known of it.

    Args:
        error: What ended the program.
    """
    match error:
        case ImportError():
            from studio.importable.hints.imports import import_hint  # noqa: PLC0415 - takes long

            return import_hint(error)
        case SyntaxError():
            return _syntax_hint(error)
        case TypeError():
            return _answer_hint(error)
        case _:
            return None


def _syntax_hint(error: SyntaxError) -> str | None:
    """Return a sentence about a file that cannot be read as Python; None: it names no file."""
    if not error.filename or error.lineno is None or error.filename.startswith("<"):
        return None
    at = place_of(error.filename, error.lineno)
    if isinstance(error, TabError):
        return f"{at}: indent every line with spaces, four a level, and none with tabs."
    if isinstance(error, IndentationError):
        return (
            f"{at}: the indentation of the lines is not as Python needs it, as after copying from "
            "a slide or a PDF: indent what belongs to a class, def, if or loop by four spaces."
        )
    return f"{at} is no Python, so nothing of the file was run: mend that line or the one above it."


def _answer_hint(error: TypeError) -> str | None:
    """Return a sentence about a service's callback that returned nothing: only our code is seen."""
    if "NoneType" not in str(error):
        return None
    for frame, _ in traceback.walk_tb(error.__traceback__):
        service: Any = frame.f_locals.get("self")
        if isinstance(service, Service) and frame.f_locals.get("given", error) is None:
            called: Any = service.callback
            code: Any = getattr(called, "__code__", None)
            at = f" ({place_of(code.co_filename, code.co_firstlineno)})" if code else ""
            name = getattr(called, "__name__", "callback")
            return (
                f"The callback {name}{at} of the service {service.endpoint.token.name} returned "
                "None, and its caller waits for an answer: end it with return response."
            )
    return None


def uncalled_hint(file: str) -> str | None:
    """Return a sentence about a `main` that nothing in its file uses; None: there is none.

    Args:
        file: A program that ended without an error and made no node.
    """
    tree = tree_of(file)
    if tree is None:
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

"""Expressions without a run: those in YAML files, and what is said when one fails."""

from __future__ import annotations

import re
from typing import Any, Final

from studio.description.evaluator.symbols import pure_names
from studio.description.expressions.budget import Budget, Limits
from studio.description.expressions.expressions import compile_expression
from studio.description.faults import Fault, Refusal, shorten

_PURE_LIMITS: Final = Limits(seconds=0.5)
"""Of one expression in a YAML file."""
_TEXT_FOR_NUMBER: Final = re.compile(
    r"multiply sequence|(unsupported operand|not supported between|bad operand).*'str'"
    r"|must be real number, not str|can only concatenate str|must be str, not"
)
"""What Python says of arithmetic with a text."""


def pure_value(text: str) -> Any:  # noqa: ANN401
    """An expression of a YAML file: no names but mathematics and builtins.

    Raises:
        Fault: It cannot be evaluated.
    """
    code = compile_expression(text).code
    try:
        return eval(code, pure_names(Budget(_PURE_LIMITS).steps))
    except Fault:
        raise
    except Exception as error:  # noqa: BLE001 - whatever the expression does
        raise failed(text, error) from None


def failed(text: str, error: Exception) -> Fault:
    """What an expression's exception comes to."""
    reason = str(error.args[0]) if isinstance(error, KeyError) and error.args else str(error)
    if isinstance(error, KeyError):
        reason = f"there is no key {error}"
    if isinstance(error, TypeError) and _TEXT_FOR_NUMBER.search(reason):
        reason = "a text stands where a number is needed; is a value in it empty or no number?"
    spoken = (reason or type(error).__name__).rstrip(".")
    return Fault(
        "bad-expression",
        f'"{shorten(text)}" cannot be evaluated: {spoken}{"" if spoken.endswith("?") else "."}',
    )


def out_of_bounds(error: BaseException) -> Refusal:
    """What a RecursionError or MemoryError comes to."""
    if isinstance(error, MemoryError):
        return Refusal("value-too-large", "An expression needs too much memory.")
    return Refusal("nested-too-deep", "Properties or expressions are nested too deeply.")

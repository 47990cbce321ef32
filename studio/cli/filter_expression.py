"""`--filter`: a Python expression of a message `m`, true for messages that are taken."""

from __future__ import annotations

import ast
import warnings
from typing import TYPE_CHECKING

from studio.errors import MessageValueError, SettingsError

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import CodeType

    from studio.ros.types.classes import MessageValue

_WHERE = "--filter"
_LENGTH_MAX = 5_000
_ALLOWED: tuple[type[ast.AST], ...] = (
    *(ast.Expression, ast.BoolOp, ast.BinOp, ast.UnaryOp, ast.IfExp, ast.Compare, ast.Call),
    *(ast.Constant, ast.Name, ast.Attribute, ast.Subscript, ast.Slice, ast.List, ast.Tuple),
    *(ast.Set, ast.ListComp, ast.SetComp, ast.GeneratorExp, ast.comprehension),
    *(ast.expr_context, ast.boolop, ast.operator, ast.unaryop, ast.cmpop),
)
_FUNCTIONS = {
    function.__name__: function
    for function in (abs, all, any, bool, float, int, len, max, min, range, round, set, sorted, str,
                     sum)
}  # fmt: skip
# They reach into their arguments by names that stand in a text.
_REFUSED = frozenset({"format", "format_map"})


def filter_of(text: str) -> Callable[[MessageValue], bool]:
    """Make what decides whether a message is taken.

    It raises MessageValueError for a message that the expression has no answer for.

    Raises:
        SettingsError: It is no expression, or more than one may be.
    """
    code = _compiled(text)

    def is_taken(message: MessageValue) -> bool:
        try:
            return bool(eval(code, {"__builtins__": {}, **_FUNCTIONS, "m": message}))
        except Exception as error:  # noqa: BLE001  # whatever the user's own expression raises
            reason = " ".join(str(error).split()) or type(error).__name__
            raise MessageValueError(_WHERE, reason.rstrip(".")) from None

    return is_taken


def _compiled(text: str) -> CodeType:
    if len(text) > _LENGTH_MAX:
        raise SettingsError(f"{_WHERE}: the expression is longer than {_LENGTH_MAX} characters.")
    try:
        tree = ast.parse(text.strip(), _WHERE, "eval")
        for node in ast.walk(tree):
            _check(node)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # such as of `1 is 1`
            return compile(tree, _WHERE, "eval")
    except SyntaxError as error:
        raise SettingsError(f'{_WHERE} "{text}" is no expression of Python: {error.msg}.') from None
    except (ValueError, RecursionError, MemoryError):
        raise SettingsError(f"{_WHERE}: the expression is nested too deeply.") from None


def _check(node: ast.AST) -> None:
    if not isinstance(node, _ALLOWED):
        raise SettingsError(f"{_WHERE} takes no {type(node).__name__}: compare fields of m.")
    match node:
        case ast.Attribute(attr=name) if name.startswith("_") or name in _REFUSED:
            raise SettingsError(f'{_WHERE} takes no "{name}": compare fields of m.')
        case ast.Name(id=name) if name.startswith("_"):
            raise SettingsError(f'{_WHERE} takes no "{name}": compare fields of m.')
        case _:
            return

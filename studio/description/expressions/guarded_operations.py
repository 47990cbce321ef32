"""What a compiled expression calls instead of Python's own operators: bounded, no way out.

The operators that can grow a value (`*`, `**`, `<<`, `+`, `%`) look at the sizes first, and
attributes are looked up in a list of harmless methods, so nothing reaches a class, a frame or a
module whatever the expression is.
"""

from __future__ import annotations

from collections.abc import ItemsView, KeysView, ValuesView
from datetime import date
from typing import TYPE_CHECKING, Any, Final, cast

from studio.description.expressions.bounded_values import (
    BITS_LIMIT,
    ITEMS_LIMIT,
    SIZE_LIMIT,
    made,
    too_large,
    weight,
)
from studio.description.expressions.guarded_methods import (
    check_template,
    checked_format,
    guarded_method,
    unbound_method,
)
from studio.description.faults import Refusal

if TYPE_CHECKING:
    from collections.abc import Sized

PRINTED_LIMIT: Final = 100_000
"""Items of a value that is printed; a YAML file may hold more than an expression may make."""
__all__ = ["METHODS", "MUTATING", "SIZE_LIMIT", "made", "text_of", "too_large"]


def _names(text: str) -> frozenset[str]:
    return frozenset(text.split())


_STR: Final = _names(
    "capitalize casefold count endswith find index isalnum isalpha isascii isdecimal isdigit "
    "isidentifier islower isnumeric isprintable isspace istitle isupper join lower lstrip "
    "partition removeprefix removesuffix replace rfind rindex rpartition rsplit rstrip split "
    "splitlines startswith strip swapcase title upper "
    "center expandtabs ljust rjust zfill"
)
_DICT_READING: Final = _names("copy get items keys values")
_DICT: Final = _DICT_READING | _names("clear fromkeys pop popitem setdefault update")
_LIST: Final = _names("append clear copy count extend index insert pop remove reverse sort")
_SET: Final = _names(
    "add clear copy difference discard intersection isdisjoint issubset issuperset pop remove "
    "symmetric_difference union update"
)
_NUMBER: Final = _names("bit_length conjugate imag is_integer real")
MUTATING: Final = _names(
    "add append clear discard extend insert pop popitem remove reverse setdefault sort update"
)
"""Methods that change the value they are called on: evaluating twice is then not the same."""

METHODS: Final[dict[type, frozenset[str]]] = {
    str: _STR,
    dict: _DICT,
    list: _LIST,
    tuple: frozenset({"count", "index"}),
    set: _SET,
    frozenset: _SET - {"add", "clear", "discard", "pop", "remove", "update"},
    int: _NUMBER,
    bool: _NUMBER,
    float: _NUMBER,
    complex: _NUMBER,
    range: frozenset({"count", "index", "start", "step", "stop"}),
    date: frozenset({"day", "month", "year"}),
}
"""Attributes that an expression may ask for, by exact type."""
_WITH_METHODS: Final = frozenset({str, list, dict, set})
"""Types of which some methods are guarded."""


def attribute(value: Any, name: str) -> Any:  # noqa: ANN401 - any value of a description
    """`value.name` in an expression.

    Raises:
        Refusal: Neither a harmless method nor a name of a namespace or YAML mapping.
        AttributeError: A YAML mapping has no such key.
    """
    kind = cast("type[object]", type(value))
    if name in METHODS.get(kind, ()):
        return guarded_method(value, name) if kind in _WITH_METHODS else getattr(value, name)
    if isinstance(value, dict):
        return _named(cast("dict[str, Any]", value), name)
    if kind is type and name in METHODS.get(cast("type", value), ()):
        return unbound_method(cast("type", value), name, attribute)
    if kind is str and name == "format":
        return checked_format(value)
    if kind in METHODS and not hasattr(kind, name):
        raise AttributeError(f'a value of type {kind.__name__} has no "{name}"')
    raise Refusal("expression-refused", f'".{name}" may not be used in an expression.')


def _named(value: dict[str, Any], name: str) -> Any:  # noqa: ANN401
    """A key of a namespace or YAML mapping, which both answer `__getattr__`, else a dict method."""
    if name in _DICT_READING:
        return getattr(value, name)
    look_up = getattr(type(value), "__getattr__", None)
    if look_up is None or hasattr(dict, name) or name.startswith("__"):
        raise Refusal("expression-refused", f'".{name}" may not be used in an expression.')
    return look_up(value, name)


def multiply(left: Any, right: Any) -> Any:  # noqa: ANN401
    """`left * right`."""
    if type(left) is float or type(right) is float:
        return left * right
    if isinstance(left, int):
        if isinstance(right, int):
            if left.bit_length() + right.bit_length() > BITS_LIMIT:
                raise too_large()
        else:
            _check_repeat(right, left)
    elif isinstance(right, int):
        _check_repeat(left, right)
    return left * right


def _check_repeat(sequence: Any, times: int) -> None:  # noqa: ANN401
    if isinstance(sequence, str):
        if len(sequence) * times > SIZE_LIMIT:
            raise too_large()
    elif isinstance(sequence, list | tuple) and times > 1:
        weight(cast("object", sequence), ITEMS_LIMIT // times)


def power(base: Any, exponent: Any) -> Any:  # noqa: ANN401
    """`base ** exponent`."""
    whole = isinstance(base, int) and isinstance(exponent, int)
    if whole and exponent > 0 and base.bit_length() * exponent > BITS_LIMIT:
        raise too_large()
    return base**exponent


def shift_left(value: Any, places: Any) -> Any:  # noqa: ANN401
    """`value << places`."""
    if isinstance(places, int) and places > BITS_LIMIT:
        raise too_large()
    return made(value << places)


def add(left: Any, right: Any) -> Any:  # noqa: ANN401
    """`left + right`."""
    if type(left) is float or type(left) is int:
        return left + right
    if isinstance(left, str | list | tuple):
        limit = SIZE_LIMIT if isinstance(left, str) else ITEMS_LIMIT
        if len(cast("Sized", left)) + len(right) > limit:
            raise too_large()
    return made(left + right)


def modulo(left: Any, right: Any) -> Any:  # noqa: ANN401
    """`left % right`; a format text may not ask for wide fields."""
    if isinstance(left, str):
        check_template(left, right)
    return left % right


def type_of(value: object) -> type:
    """`type` with one argument; with three it would make a class, and so would the type of one.

    Raises:
        Refusal: The value is a function, a range or a type, say: the type of one would make others
            that nothing bounds.
    """
    kind = type(value)
    if kind is range or not (kind in METHODS or isinstance(value, dict | list | None)):
        raise Refusal(
            "expression-refused", f"The type of a {kind.__name__} may not be used in an expression."
        )
    return kind


def text_of(value: Any) -> str:  # noqa: ANN401
    """`str(value)`, as xacro prints it, of a value that is not too large to print."""
    if isinstance(value, str):
        return value
    if type(value) is not float:
        check_printable(value)
    return str(value)


def check_printable(value: Any) -> None:  # noqa: ANN401
    """See that a value can be printed: a list of lists of lists may be short and print without end.

    Raises:
        Refusal: It would print more than PRINTED_LIMIT items.
    """
    if isinstance(value, list | tuple | dict | set | KeysView | ItemsView | ValuesView):
        weight(cast("object", value), PRINTED_LIMIT)

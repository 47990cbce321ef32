"""What a compiled expression calls instead of Python's own operators: bounded, no way out.

The operators that can grow a value (`*`, `**`, `<<`, `+`, `%`) look at the sizes first, and
attributes are looked up in a list of harmless methods, so nothing reaches a class, a frame or a
module whatever the expression is.
"""

from __future__ import annotations

import re
from datetime import date
from string import Formatter
from typing import TYPE_CHECKING, Any, Final, cast

from studio.description.faults import Refusal

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sized

SIZE_LIMIT: Final = 1_000_000
"""Characters of a text, items of a list."""
BITS_LIMIT: Final = 8_192
"""Of a whole number; 2,466 digits."""
_PADDING_LIMIT: Final = 10_000
_WIDE_FIELD: Final = re.compile(r"\d{5,}|\*")


def _names(text: str) -> frozenset[str]:
    return frozenset(text.split())


_STR: Final = _names(
    "capitalize casefold count endswith find index isalnum isalpha isascii isdecimal isdigit "
    "isidentifier islower isnumeric isprintable isspace istitle isupper join lower lstrip "
    "partition removeprefix removesuffix replace rfind rindex rpartition rsplit rstrip split "
    "splitlines startswith strip swapcase title upper"
)
_PADDING: Final = _names("center expandtabs ljust rjust zfill")
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


def attribute(value: Any, name: str) -> Any:  # noqa: ANN401 - any value of a description
    """`value.name` in an expression.

    Raises:
        Refusal: Neither a harmless method nor a name of a namespace or YAML mapping.
        AttributeError: A YAML mapping has no such key.
    """
    kind = cast("type[object]", type(value))
    if name in METHODS.get(kind, ()):
        return getattr(value, name)
    if isinstance(value, str) and name in _PADDING:
        return _padded(cast("Callable[..., str]", getattr(value, name)))
    if isinstance(value, dict):
        return _named(cast("dict[str, Any]", value), name)
    if kind is type and name in METHODS.get(cast("type", value), ()):
        return getattr(value, name)
    if kind is str and name == "format":
        return _checked_format(value)
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


def _padded(method: Callable[..., str]) -> Callable[..., str]:
    def pad(width: int = 8, *fill: str) -> str:
        if width > _PADDING_LIMIT:
            raise too_large()
        return method(width, *fill)

    return pad


def _checked_format(template: str) -> Callable[..., str]:
    """`template.format`: fields by number or name only, no attribute, index, nested or wide field.

    A field like `{0.__globals__}` would print what no expression can reach.
    """
    for _literal, field, layout, _conversion in Formatter().parse(template):
        plain = not field or field.isidentifier() or field.isdigit()
        if not plain or "{" in (layout or "") or _WIDE_FIELD.search(layout or ""):
            raise Refusal("expression-refused", f'The format "{template}" has a field too complex.')
    return template.format


def too_large() -> Refusal:
    """What every size guard raises."""
    return Refusal("value-too-large", "An expression makes a value that is too large.")


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
    if hasattr(sequence, "__len__") and len(cast("Sized", sequence)) * times > SIZE_LIMIT:
        raise too_large()


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
    return value << places


_GROWING: Final = frozenset({str, list, tuple})


def add(left: Any, right: Any) -> Any:  # noqa: ANN401
    """`left + right`."""
    grows = type(left) in _GROWING and type(right) in _GROWING
    if grows and len(left) + len(right) > SIZE_LIMIT:
        raise too_large()
    return left + right


def modulo(left: Any, right: Any) -> Any:  # noqa: ANN401
    """`left % right`; a format text may not ask for wide fields."""
    if isinstance(left, str) and _WIDE_FIELD.search(left):
        raise too_large()
    return left % right


def bounded_range(*bounds: int) -> range:
    """`range` of at most SIZE_LIMIT steps."""
    made = range(*bounds)
    if not -SIZE_LIMIT <= (made.stop - made.start) // made.step <= SIZE_LIMIT:
        raise too_large()
    return made


def bounded_round(number: Any, digits: int | None = None) -> Any:  # noqa: ANN401
    """`round`; the number of digits must be sensible."""
    if digits is not None and abs(digits) > 400:
        raise too_large()
    return round(number, digits)


def bounded(function: Callable[..., Any], limit: int) -> Callable[..., Any]:
    """A function of whole numbers that may not be larger than `limit`."""

    def call(*arguments: Any) -> Any:  # noqa: ANN401
        if any(isinstance(one, int) and one > limit for one in arguments):
            raise too_large()
        return function(*arguments)

    return call


def type_of(value: object) -> type:
    """`type` with one argument; with three it would make a class."""
    return type(value)


def text_of(value: Any) -> str:  # noqa: ANN401
    """`str(value)`, as xacro prints it, of a value that is not too large to print."""
    if isinstance(value, str):
        return value
    check_printable(value)
    return str(value)


def check_printable(value: Any) -> None:  # noqa: ANN401
    """See that a value can be printed: a list of lists of lists may be short and print without end.

    Raises:
        Refusal: It would print more than a tenth of SIZE_LIMIT items.
    """
    if isinstance(value, list | tuple | dict | set):
        _count(cast("object", value), SIZE_LIMIT // 10)


def _count(value: Any, left: int) -> int:  # noqa: ANN401
    """What is left of `left` items after all items of a container, repeats counted each time."""
    if left <= 0:
        raise too_large()
    for item in _items(value):
        left = _count(item, left - 1)
    return left


def _items(value: Any) -> Iterator[Any]:  # noqa: ANN401
    """Raw items: looking at a YAML value must not count as reading it."""
    if isinstance(value, dict):
        return iter(cast("Any", dict).values(value))
    if isinstance(value, list):
        return cast("Any", list).__iter__(value)
    if isinstance(value, tuple | set):
        return iter(cast("Iterable[Any]", value))
    return iter(())

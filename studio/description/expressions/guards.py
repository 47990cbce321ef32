"""Replacements of Python's own operators and methods in a compiled expression.

The operators that can grow a value (`*`, `**`, `<<`, `+`, `%`) check the sizes first. Attributes
must be in a list of harmless methods, so no expression reaches a class, a frame or a module.
Most methods are as quick as their value is small; those that can take or make far more than they
are given, such as `rfind` and `replace`, check the sizes first, too.
"""

from __future__ import annotations

import re
from collections.abc import ItemsView, KeysView, ValuesView
from datetime import date
from string import Formatter
from typing import TYPE_CHECKING, Any, Final, cast

from studio.description.expressions.bounds import (
    BITS_LIMIT,
    ITEMS_LIMIT,
    SIZE_LIMIT,
    made,
    too_large,
    weight,
)
from studio.description.faults import Refusal

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sized

WORK_LIMIT: Final = 100_000_000
"""Comparisons of characters; a tenth of a second."""
_PADDING_LIMIT: Final = 10_000
_WIDE_FIELD: Final = re.compile(r"\d{5,}|\*")
_WIDTH: Final = re.compile(r"\d+")
_GROWING: Final = frozenset({"add", "append", "extend", "insert", "setdefault", "update"})
_SORT_KEYS: Final[tuple[object, ...]] = (None, len, str, int, float, bool)
PRINTED_LIMIT: Final = 100_000
"""Items of a value that is printed; a YAML file may hold more than an expression may make."""
_WITH_METHODS: Final = frozenset({str, list, dict, set})
"""Types of which some methods are guarded."""


def guarded_method(value: Any, name: str) -> Callable[..., Any]:  # noqa: ANN401
    """`value.name`, a method that an expression may call; its calls raise Refusals."""
    method = cast("Callable[..., Any]", getattr(value, name))
    if isinstance(value, str):
        guard = _TEXT_GUARDS.get(name)
        return guard(value, method) if guard else method
    if name in _GROWING:
        return _weighing(value, method)
    if name == "sort":
        return _sorting(method)
    return method


def unbound_method(kind: type, name: str, find: Callable[[Any, str], Any]) -> Callable[..., Any]:
    """`kind.name`, to be called with a value of that type; `find` finds the value's method."""
    if name == "fromkeys":
        return cast("Callable[..., Any]", getattr(kind, name))

    def call(value: Any, *arguments: Any, **named: Any) -> Any:  # noqa: ANN401
        if not isinstance(value, kind):
            raise TypeError(f"{kind.__name__}.{name} is for values of that type")
        return find(value, name)(*arguments, **named)

    return call


def _weighing(value: Any, method: Callable[..., Any]) -> Callable[..., Any]:  # noqa: ANN401
    def call(*arguments: Any, **named: Any) -> Any:  # noqa: ANN401
        result = method(*map(_bounded, arguments), **named)
        weight(value)
        return result

    return call


def _bounded(argument: Any) -> Any:  # noqa: ANN401
    """Return the argument; an iterator ends in a Refusal where it gives too much.

    One that reads the very list that it extends would never end.
    """
    kind = cast("type[object]", type(argument))
    return _first_items(argument) if hasattr(kind, "__next__") else argument


def _first_items(items: Iterator[Any]) -> Iterator[Any]:
    for number, item in enumerate(items):
        if number >= ITEMS_LIMIT:
            raise too_large()
        yield item


def _sorting(method: Callable[..., None]) -> Callable[..., None]:
    def sort(*, key: Any = None, reverse: bool = False) -> None:  # noqa: ANN401
        if key not in _SORT_KEYS:
            sentence = "sort() takes no key of this kind in an expression: use sorted()."
            raise Refusal("expression-refused", sentence)
        method(key=key, reverse=reverse)

    return sort


def _comparing(value: str, method: Callable[..., Any]) -> Callable[..., Any]:
    """Return a method that may compare each character of the value with each of its arguments."""

    def call(*arguments: Any) -> Any:  # noqa: ANN401
        if len(value) * sum(map(_characters, arguments)) > WORK_LIMIT:
            raise too_large()
        return method(*arguments)

    return call


def _characters(argument: Any) -> int:  # noqa: ANN401
    if isinstance(argument, str):
        return len(argument)
    if isinstance(argument, tuple):
        return sum(map(_characters, cast("tuple[Any, ...]", argument)))
    return 0


def _replacing(value: str, method: Callable[..., str]) -> Callable[..., str]:
    def replace(old: str, new: str, count: int = -1) -> str:
        times = value.count(old)
        if len(value) + times * max(0, len(new) - len(old)) > SIZE_LIMIT:
            raise too_large()
        return method(old, new, count)

    return replace


def _joining(value: str, method: Callable[..., str]) -> Callable[..., str]:
    def join(items: Iterable[str]) -> str:
        texts = list(items)
        if len(value) * len(texts) > SIZE_LIMIT:
            raise too_large()
        return method(texts)

    return join


def _padding(_value: str, method: Callable[..., str]) -> Callable[..., str]:
    def pad(width: int, *fill: str) -> str:
        if width > _PADDING_LIMIT:
            raise too_large()
        return method(width, *fill)

    return pad


def _expanding(value: str, method: Callable[..., str]) -> Callable[..., str]:
    def expand(tabsize: int = 8) -> str:
        if value.count("\t") * tabsize > SIZE_LIMIT:
            raise too_large()
        return method(tabsize)

    return expand


_TEXT_GUARDS: Final[dict[str, Callable[[str, Callable[..., Any]], Callable[..., Any]]]] = {
    **dict.fromkeys(("rfind", "rindex", "rpartition", "rsplit"), _comparing),
    **dict.fromkeys(("strip", "lstrip", "rstrip", "startswith", "endswith"), _comparing),
    **dict.fromkeys(("center", "ljust", "rjust", "zfill"), _padding),
    "expandtabs": _expanding,
    "join": _joining,
    "replace": _replacing,
}


def checked_format(template: str) -> Callable[..., str]:
    """`template.format`: fields by number or name only, no attribute, index, nested or wide field.

    A field like `{0.__globals__}` would print what no expression can reach.
    """
    fields = widths = 0
    for _literal, field, layout, _conversion in Formatter().parse(template):
        plain = not field or field.isidentifier() or field.isdigit()
        if not plain or "{" in (layout or "") or _WIDE_FIELD.search(layout or ""):
            raise Refusal("expression-refused", f'The format "{template}" has a field too complex.')
        fields += field is not None
        widths += sum(int(width) for width in _WIDTH.findall(layout or ""))

    def format_fields(*arguments: Any, **named: Any) -> str:  # noqa: ANN401
        check_fields(fields, widths, [*arguments, *named.values()])
        return template.format(*arguments, **named)

    return format_fields


def check_template(template: str, values: Any) -> None:  # noqa: ANN401
    """Raise a Refusal if `template % values` grows too large."""
    if _WIDE_FIELD.search(template):
        raise too_large()
    given = cast("tuple[Any, ...]", values) if isinstance(values, tuple) else (values,)
    widths = sum(int(width) for width in _WIDTH.findall(template))
    check_fields(template.count("%"), widths, given)


def check_fields(fields: int, widths: int, values: Iterable[Any]) -> None:
    """Raise a Refusal if a format of so many fields grows too large."""
    longest = max(map(_printed_size, values), default=0)
    if fields > 1 and (widths + fields * longest) > SIZE_LIMIT:
        raise too_large()


def _printed_size(value: Any) -> int:  # noqa: ANN401
    return len(value) if isinstance(value, str) else 64 * weight(value)


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
    """Return a key of a namespace or YAML mapping by `__getattr__`, else a dict method."""
    if name in _DICT_READING:
        return getattr(value, name)
    find = getattr(type(value), "__getattr__", None)
    if find is None or hasattr(dict, name) or name.startswith("__"):
        raise Refusal("expression-refused", f'".{name}" may not be used in an expression.')
    return find(value, name)


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
    """Return `type` of one argument; with three it would make a class, and so would a metatype.

    Raises:
        Refusal: The value is, for example, a function, a range or a type, whose type would make
            others without bounds.
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
    """Check that a value can be printed: a short list of lists may print without end.

    Raises:
        Refusal: It would print more than PRINTED_LIMIT items.
    """
    if isinstance(value, list | tuple | dict | set | KeysView | ItemsView | ValuesView):
        weight(cast("object", value), PRINTED_LIMIT)

"""Methods of texts, lists and mappings that look at the sizes before they do the work.

Most methods are as quick as their value is small. Those here can take or make far more than they
are given: searching backwards for a text that nearly fits, replacing a letter by a book.
"""

from __future__ import annotations

import re
from string import Formatter
from typing import TYPE_CHECKING, Any, Final, cast

from studio.description.expressions.bounded_values import (
    ITEMS_LIMIT,
    SIZE_LIMIT,
    too_large,
    weight,
)
from studio.description.faults import Refusal

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

WORK_LIMIT: Final = 100_000_000
"""Comparisons of characters; a tenth of a second."""
_PADDING_LIMIT: Final = 10_000
_WIDE_FIELD: Final = re.compile(r"\d{5,}|\*")
_WIDTH: Final = re.compile(r"\d+")
_GROWING: Final = frozenset({"add", "append", "extend", "insert", "setdefault", "update"})
_SORT_KEYS: Final[tuple[object, ...]] = (None, len, str, int, float, bool)


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


def unbound_method(kind: type, name: str, look_up: Callable[[Any, str], Any]) -> Callable[..., Any]:
    """`kind.name`, to be called with a value of that type; `look_up` finds the value's method."""
    if name == "fromkeys":
        return cast("Callable[..., Any]", getattr(kind, name))

    def call(value: Any, *arguments: Any, **named: Any) -> Any:  # noqa: ANN401
        if not isinstance(value, kind):
            raise TypeError(f"{kind.__name__}.{name} is for values of that type")
        return look_up(value, name)(*arguments, **named)

    return call


def _weighing(value: Any, method: Callable[..., Any]) -> Callable[..., Any]:  # noqa: ANN401
    def call(*arguments: Any, **named: Any) -> Any:  # noqa: ANN401
        result = method(*map(_bounded, arguments), **named)
        weight(value)
        return result

    return call


def _bounded(argument: Any) -> Any:  # noqa: ANN401
    """The argument; an iterator ends in a Refusal where it gives too much.

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
    """A method that may compare each character of the value with each of its arguments."""

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
    """See that `template % values` does not grow too large; raises a Refusal."""
    if _WIDE_FIELD.search(template):
        raise too_large()
    given = cast("tuple[Any, ...]", values) if isinstance(values, tuple) else (values,)
    widths = sum(int(width) for width in _WIDTH.findall(template))
    check_fields(template.count("%"), widths, given)


def check_fields(fields: int, widths: int, values: Iterable[Any]) -> None:
    """See that a format of so many fields does not grow too large; raises a Refusal."""
    longest = max(map(_printed_size, values), default=0)
    if fields > 1 and (widths + fields * longest) > SIZE_LIMIT:
        raise too_large()


def _printed_size(value: Any) -> int:  # noqa: ANN401
    return len(value) if isinstance(value, str) else 64 * weight(value)

"""Functions that expressions know by name, where Python's own could go on or grow without end.

Those that call another function for each item count each call: a loop inside C looks at no clock.
"""

from __future__ import annotations

import math
import re
from itertools import repeat
from typing import TYPE_CHECKING, Any, Final, cast

from studio.description.expressions.bounds import ITEMS_LIMIT, made, too_large
from studio.description.expressions.guards import add, multiply, type_of
from studio.description.faults import Refusal

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

RANGE_LIMIT: Final = 100_000
"""Steps of a `range`."""
_RANGE_BITS: Final = 62
"""Numbers further apart than a hash is wide may all have the same one."""
_FACTORIAL_LIMIT: Final = 170
"""The last whose factorial fits into a float."""
_DIGITS_LIMIT: Final = 400


def bounded_range(*bounds: int) -> range:
    """`range` of at most RANGE_LIMIT steps."""
    if any(one.bit_length() > _RANGE_BITS for one in bounds):
        raise too_large()
    steps = range(*bounds)
    if len(steps) > RANGE_LIMIT:
        raise too_large()
    return steps


def bounded_round(number: Any, digits: int | None = None) -> Any:  # noqa: ANN401
    """`round`; the number of digits must be sensible."""
    if digits is not None and abs(digits) > _DIGITS_LIMIT:
        raise too_large()
    return round(number, digits)


def bounded_sum(items: Iterable[Any], start: Any = 0) -> Any:  # noqa: ANN401
    """`sum`; lists, which it copies again and again, may not grow too large."""
    if isinstance(start, int | float):
        return sum(items, start)
    total: Any = start
    for item in items:
        total = add(total, item)
    return total


def _bounded(function: Callable[..., Any]) -> Callable[..., Any]:
    def call(*arguments: Any) -> Any:  # noqa: ANN401
        if any(isinstance(one, int) and one > _FACTORIAL_LIMIT for one in arguments):
            raise too_large()
        return function(*arguments)

    return call


def _product(items: Iterable[Any], *, start: Any = 1) -> Any:  # noqa: ANN401
    total: Any = start
    for item in items:
        total = multiply(total, item)
    return total


def _multiple(*numbers: int) -> int:
    total = 1
    for number in numbers:
        total = cast("int", made(math.lcm(total, number)))
    return total


MATH: Final[dict[str, Any]] = {
    **{name: value for name, value in vars(math).items() if not name.startswith("_")},
    **{name: _bounded(getattr(math, name)) for name in ("factorial", "comb", "perm")},
    "prod": _product,
    "lcm": _multiple,
}
"""Mathematics."""


def tokenize(text: str, sep: str = ",; ", skip_empty: bool = True) -> list[str]:  # noqa: FBT001, FBT002 - xacro's
    """Split a text at any of the separators.

    Raises:
        Refusal: They hold a `]`, behind which they would be any pattern, also one without end.
    """
    if "]" in sep or len(sep) > ITEMS_LIMIT:
        raise Refusal("expression-refused", 'The separators of tokenize() may not hold "]".')
    parts = re.split(f"[{sep}]", text)
    return [part for part in parts if part] if skip_empty else parts


def counted_functions(steps: Callable[[Iterable[Any]], Iterator[Any]]) -> dict[str, Any]:
    """`map` and its like, every call of the function that they are given counted by `steps`."""

    def counted(function: Callable[..., Any] | None) -> Callable[..., Any] | None:
        if function is None:
            return None
        ticks = steps(repeat(None))

        def call(*arguments: Any) -> Any:  # noqa: ANN401
            next(ticks)
            return made(function(*arguments))

        return call

    def with_key(function: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any, **named: Any) -> Any:  # noqa: ANN401
            if "key" in named:
                named["key"] = counted(named["key"])
            return function(*arguments, **named)

        return call

    def mapped(function: Callable[..., Any], *items: Iterable[Any]) -> Iterator[Any]:
        return map(cast("Callable[..., Any]", counted(function)), *items)

    def filtered(function: Callable[..., Any] | None, items: Iterable[Any]) -> Iterator[Any]:
        return filter(counted(function), items)

    def zipped(*items: Iterable[Any], strict: bool = False) -> Iterator[Any]:
        return steps(zip(*items, strict=strict))

    return {
        "map": mapped,
        "filter": filtered,
        "sorted": with_key(sorted),
        "min": with_key(min),
        "max": with_key(max),
        "zip": zipped,
    }


def guarded_functions(steps: Callable[[Iterable[Any]], Iterator[Any]]) -> dict[str, Any]:
    """All that stands in place of a function of Python or xacro, by its name."""
    return {
        **{name: MATH[name] for name in ("factorial", "comb", "perm", "prod", "lcm")},
        **counted_functions(steps),
        "range": bounded_range,
        "round": bounded_round,
        "sum": bounded_sum,
        "tokenize": tokenize,
        "type": type_of,
    }

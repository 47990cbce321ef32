"""The names that every expression knows: those that xacro 2.1.1 exposes, the risky ones bounded.

Builtins stand alone and in `python`, mathematics alone and in `math`, xacro's own in `xacro`.
Functions that Python lets go on or grow without end are bounded, and those that call another
function for each item count each call: a loop inside C does not check the clock.
"""

from __future__ import annotations

import math
import re
from itertools import repeat
from typing import TYPE_CHECKING, Any, Final, Protocol, cast

from studio.description.expressions.bounds import ITEMS_LIMIT, made, too_large
from studio.description.expressions.expressions import helpers_of
from studio.description.expressions.guards import add, multiply, text_of, type_of
from studio.description.faults import Fault, Refusal

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
    """Return replacements for functions of Python or xacro, by name."""
    return {
        **{name: MATH[name] for name in ("factorial", "comb", "perm", "prod", "lcm")},
        **counted_functions(steps),
        "range": bounded_range,
        "round": bounded_round,
        "sum": bounded_sum,
        "tokenize": tokenize,
        "type": type_of,
    }


class Namespace(dict[str, Any]):
    """A fixed set of names inside expressions: `math.pi`."""

    __slots__ = ()

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401
        try:
            return self[name]
        except KeyError:
            raise NameError(f"name '{name}' is not defined") from None


_LONG_EXPOSED: Final[dict[str, Any]] = {
    "list": list,
    "dict": dict,
    "map": map,
    "len": len,
    "str": str,
    "float": float,
    "int": int,
    "bool": bool,
    "True": True,
    "False": False,
    "min": min,
    "max": max,
    "round": bounded_round,
}


_RECENT: Final[dict[str, Any]] = {"sorted": sorted, "range": bounded_range}


_PYTHON: Final[dict[str, Any]] = {
    **_LONG_EXPOSED,
    **_RECENT,
    "abs": abs,
    "all": all,
    "any": any,
    "complex": complex,
    "divmod": divmod,
    "enumerate": enumerate,
    "filter": filter,
    "frozenset": frozenset,
    "hash": hash,
    "isinstance": isinstance,
    "issubclass": issubclass,
    "ord": ord,
    "repr": repr,
    "reversed": reversed,
    "slice": slice,
    "set": set,
    "sum": bounded_sum,
    "tuple": tuple,
    "type": type_of,
    "zip": zip,
}


PURE_SYMBOLS: Final[dict[str, Any]] = {**_LONG_EXPOSED, **MATH}
"""Names that need no run: for the tags of YAML files, and to know what a property hides."""


SAFE_BUILTINS: Final[dict[str, Any]] = _PYTHON
"""Builtins that `$(eval ...)` sees, with the counted functions of its run in their place."""


class Services(Protocol):
    """The part of a run that xacro's own functions use."""

    def load_yaml(self, path: str) -> Any:  # noqa: ANN401
        """Return the values of a YAML file."""
        ...

    def absolute(self, path: str) -> str:
        """Return a path as seen from the file being processed."""
        ...

    def dotify(self, items: dict[Any, Any]) -> Any:  # noqa: ANN401
        """Return a mapping whose keys are read with dots, too."""
        ...

    def argument(self, name: str) -> str:
        """Return the value of an arg."""
        ...

    def log(self, severity: str, text: str) -> None:
        """A message of the description: `message`, `warning`, `error` or `deprecated`."""
        ...

    def steps(self, items: Iterable[Any]) -> Iterator[Any]:
        """Return the items of a loop, each counted."""
        ...


def make_symbols(services: Services) -> dict[str, Any]:
    """Return all global names of one run; fresh namespaces, so that no run can change another's."""
    own = {
        "load_yaml": services.load_yaml,
        "abs_filename": services.absolute,
        "dotify": services.dotify,
    }
    xacro = Namespace(own)
    xacro.update(arg=services.argument, fatal=_fatal, tokenize=tokenize, print_location=_silent)
    xacro.update({level: _messenger(services, level) for level in ("message", "warning", "error")})
    counted = counted_functions(services.steps)
    recent = {name: counted.get(name, one) for name, one in _RECENT.items()}
    return {
        **PURE_SYMBOLS,
        **{name: one for name, one in counted.items() if name in _LONG_EXPOSED},
        **_deprecated(services, recent, "python"),
        **_deprecated(services, own, "xacro"),
        "python": Namespace(_PYTHON | counted),
        "math": Namespace(MATH),
        "xacro": xacro,
    }


def _deprecated(
    services: Services, functions: dict[str, Callable[..., Any]], namespace: str
) -> dict[str, Any]:
    def warning(name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any, **named: Any) -> Any:  # noqa: ANN401
            services.log("deprecated", f"{name}() is deprecated: write {namespace}.{name}().")
            return function(*arguments, **named)

        return call

    return {name: warning(name, function) for name, function in functions.items()}


def _messenger(services: Services, level: str) -> Callable[..., str]:
    def log(*values: Any, **_options: Any) -> str:  # noqa: ANN401
        services.log(level, " ".join(text_of(value) for value in values))
        return ""

    return log


def _silent(*_arguments: object, **_named: object) -> str:
    return ""


def _fatal(*values: Any) -> None:  # noqa: ANN401
    raise Fault("fatal", " ".join(text_of(value) for value in values))


def pure_names(steps: Callable[[Iterable[Any]], Iterator[Any]]) -> dict[str, Any]:
    """Return the names in an expression of a YAML file; `steps` counts the turns of its loops."""
    counted = counted_functions(steps)
    known = {name: counted.get(name, one) for name, one in PURE_SYMBOLS.items()}
    return {**helpers_of(steps), **known}

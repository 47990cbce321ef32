"""The names that every expression can use: those that xacro 2.1.1 exposes, the risky ones bounded.

Builtins stand alone and in `python`, mathematics alone and in `math`, xacro's own in `xacro`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, Protocol

from studio.description.evaluator.scopes import Namespace
from studio.description.evaluator.yaml_values import YamlMapping
from studio.description.expressions.expressions import helpers_of
from studio.description.expressions.guarded_functions import (
    MATH,
    bounded_range,
    bounded_round,
    bounded_sum,
    counted_functions,
    tokenize,
)
from studio.description.expressions.guards import text_of, type_of
from studio.description.faults import Fault

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

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
"""What needs no run: for the tags of YAML files, and to know what a property hides."""
SAFE_BUILTINS: Final[dict[str, Any]] = _PYTHON
"""Builtins that `$(eval ...)` sees, with the counted functions of its run in their place."""


class Services(Protocol):
    """What xacro's own functions need of the run."""

    def load_yaml(self, path: str) -> Any:  # noqa: ANN401
        """The values of a YAML file."""
        ...

    def absolute(self, path: str) -> str:
        """A path as seen from the file being processed."""
        ...

    def argument(self, name: str) -> str:
        """The value of an arg."""
        ...

    def say(self, severity: str, text: str) -> None:
        """A message of the description: `message`, `warning`, `error` or `deprecated`."""
        ...

    def steps(self, items: Iterable[Any]) -> Iterator[Any]:
        """The items of a loop, each counted."""
        ...


def make_symbols(services: Services) -> dict[str, Any]:
    """All global names of one run; fresh namespaces, so that no run can change another's."""
    own = {
        "load_yaml": services.load_yaml,
        "abs_filename": services.absolute,
        "dotify": _dotify,
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
            services.say("deprecated", f"{name}() is deprecated: write {namespace}.{name}().")
            return function(*arguments, **named)

        return call

    return {name: warning(name, function) for name, function in functions.items()}


def _messenger(services: Services, level: str) -> Callable[..., str]:
    def say(*words: Any, **_options: Any) -> str:  # noqa: ANN401
        services.say(level, " ".join(text_of(word) for word in words))
        return ""

    return say


def _silent(*_arguments: object, **_named: object) -> str:
    return ""


def _fatal(*words: Any) -> None:  # noqa: ANN401
    raise Fault("fatal", " ".join(text_of(word) for word in words))


def _dotify(items: dict[Any, Any]) -> YamlMapping:
    return YamlMapping(items, None, ())


def pure_names(steps: Callable[[Iterable[Any]], Iterator[Any]]) -> dict[str, Any]:
    """What an expression of a YAML file knows; `steps` counts the turns of its loops."""
    counted = counted_functions(steps)
    known = {name: counted.get(name, one) for name, one in PURE_SYMBOLS.items()}
    return {**helpers_of(steps), **known}

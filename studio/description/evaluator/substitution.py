"""`$(find ...)`, `$(arg ...)`, `$(env ...)`, `$(optenv ...)` and `$(eval ...)`, as in xacro."""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Protocol

from studio.description.expressions.expressions import compile_expression, helpers_of
from studio.description.expressions.guards import text_of
from studio.description.expressions.symbols import MATH, SAFE_BUILTINS, counted_functions
from studio.description.faults import Fault, Refusal, misnamed, shorten
from studio.packages.uris import is_misspelt

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

_COMMANDS: Final = ("find", "env", "optenv", "dirname", "arg")
_FIND_ONLY: Final = ("find",)
_COMMAND: Final = re.compile(r"\$\(([^$()]+)\)")
_NESTED: Final = re.compile(r"\$\([^)]*[$(]")
LENGTH_LIMIT: Final = 1_000_000
"""Characters of a text with all its substitutions."""


class Context(Protocol):
    """The part of a run that substitutions use."""

    environment: dict[str, str]

    def argument(self, name: str) -> str:
        """Return the value of an arg; Fault when it was not given."""
        ...

    def find_package(self, name: str) -> str:
        """Return the folder of a package; Fault when there is none."""
        ...

    def steps(self, items: Iterable[Any]) -> Iterator[Any]:
        """Return the items of a loop, each counted."""
        ...


def substitute(command: str, context: Context) -> str:
    """Return the value of `$(command)`.

    Raises:
        Fault: The command is unknown, lacks its argument, or names what does not exist.
    """
    text = f"$({command})"
    if command.startswith("eval "):
        return evaluate(command[5:], context)
    resolved = _resolve(text, context, _COMMANDS)
    if "$" in resolved:  # the value of an arg may hold a $(find ...)
        resolved = _resolve(resolved, context, _FIND_ONLY)
    if len(resolved) > LENGTH_LIMIT:
        raise Refusal("value-too-large", "A substitution makes a text that is too large.")
    return resolved


def _resolve(text: str, context: Context, active: tuple[str, ...]) -> str:
    for command in _commands_in(text):
        parts = [part for part in command.split(" ") if part]
        if not parts or parts[0] not in _COMMANDS:
            raise Fault(
                "bad-substitution",
                f'"$({shorten(command)})" is not known: use $(find), $(arg), $(env), $(optenv) '
                "or $(eval).",
            )
        if parts[0] in active:
            value = _value(parts[0], parts[1:], command, context)
            text = text.replace(f"$({command})", value)
    return text


def _value(name: str, parts: list[str], command: str, context: Context) -> str:
    if name == "optenv" and parts:
        return context.environment.get(parts[0], " ".join(parts[1:]))
    if name == "dirname":
        raise Fault("bad-substitution", "$(dirname) is not known in xacro: use $(find package).")
    if len(parts) != 1:
        raise Fault("bad-substitution", f'"$({shorten(command)})" must name one thing.')
    if name == "arg":
        return context.argument(parts[0])
    if name == "find":
        return context.find_package(parts[0])
    return variable(parts[0], context)


def variable(name: str, context: Context) -> str:
    """`$(env name)`.

    Raises:
        Fault: It is not set, or not in the environment that is shown.
    """
    try:
        return context.environment[name]
    except KeyError:
        sentence = (
            f'The environment variable "{name}" is not set or may not be seen: '
            f"write $(optenv {name} default)."
        )
        raise Fault("environment-missing", sentence) from None


@lru_cache(maxsize=4096)
def _commands_in(text: str) -> tuple[str, ...]:
    """Return the insides of all `$(...)` of a text."""
    if _NESTED.search(text):
        raise Fault("bad-substitution", f'"$" or "(" stands inside $(...) in "{shorten(text)}".')
    return tuple(_COMMAND.findall(text))


def evaluate(text: str, context: Context) -> str:
    """`$(eval text)`: Python over args by name, mathematics, and env, optenv, find, arg.

    Raises:
        Fault: Python cannot parse it.
        Refusal: It uses what is not allowed.
    """
    if "__" in text:
        raise Refusal("expression-refused", '$(eval ...) may not contain "__".')
    expression = compile_expression(text)
    names = _EvalNames(context)
    return text_of(eval(expression.code, names))


class _EvalNames(dict[str, Any]):
    """The names of `$(eval ...)`: functions, then args, then builtins."""

    def __init__(self, context: Context) -> None:
        super().__init__(helpers_of(context.steps))
        self._context = context
        self._builtins = SAFE_BUILTINS | counted_functions(context.steps)
        self.update(MATH)
        self.update({"true": True, "false": False, "True": True, "False": False})
        self["arg"] = self._argument
        self["find"] = context.find_package
        self["env"] = self._variable
        self["optenv"] = context.environment.get

    def _argument(self, name: str) -> Any:  # noqa: ANN401
        return auto_typed(self._context.argument(name))

    def _variable(self, name: str) -> str:
        return variable(name, self._context)

    def __missing__(self, name: str) -> Any:  # noqa: ANN401
        try:
            return self._argument(name)
        except Fault:
            if name in self._builtins:
                return self._builtins[name]
            raise NameError(f"name '{name}' is not defined") from None


def auto_typed(text: str) -> Any:  # noqa: ANN401
    """Return an arg for `$(eval)`: float with a point, else int, true or false, or text."""
    try:
        return float(text) if "." in text else int(text)
    except ValueError:
        return {"true": True, "false": False}.get(text.lower(), text)


def find_package(packages: Mapping[str, tuple[str, ...]], name: str, asking_file: str) -> str:
    """Return the folder of a package: of several, that with the longest path in common.

    Raises:
        Fault: There is none of that name; its fix is to write one that is near, or to choose the
            folder.
    """
    folders = packages.get(name, ())
    if not folders:
        sentence = f'The package "{name}" was not found'
        otherwise = "choose its folder or give --package-path."
        # A part that many packages end with, as _description, makes no two of them alike.
        alike = [one for one in packages if is_misspelt(name, one)]
        fault = misnamed("package-not-found", sentence, name, alike, otherwise)
        fault.package = name
        raise fault
    if len(folders) == 1:
        return folders[0]
    asking = Path(asking_file).parts
    return max(folders, key=lambda folder: _shared(Path(folder).parts, asking))


def _shared(left: Sequence[str], right: Sequence[str]) -> int:
    count = 0
    for one, other in zip(left, right, strict=False):
        if one != other:
            break
        count += 1
    return count

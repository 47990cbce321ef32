"""Texts with substitutions in them, `$(var name)`, as XML and YAML launch files have them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from studio.errors import LaunchError
from studio.launch.vocabulary import substitutions as subs
from studio.launch.vocabulary.texts import Substitution, TextSubstitution, described

if TYPE_CHECKING:
    from collections.abc import Callable

LETTERS_MAX: Final = 1_000_000
DEPTH_MAX: Final = 24

_Texts = list[Substitution]


def parse_text(text: str) -> list[Substitution]:
    """Return a text's parts.

    Raises:
        LaunchError: A substitution is not closed, unknown, or has too few arguments.
    """
    if len(text) > LETTERS_MAX:
        raise LaunchError(f"a text has more than {LETTERS_MAX} letters")
    reader = _Reader(text)
    return reader.template("", 0)


class _Reader:
    """Reads from left to right; `at` is where it is."""

    def __init__(self, text: str) -> None:
        self.text, self.at = text, 0

    def template(self, end: str, depth: int) -> _Texts:
        """Read as far as a letter of `end`, or to the end of the text."""
        if depth > DEPTH_MAX:
            raise LaunchError(f"substitutions stand more than {DEPTH_MAX} deep in each other")
        parts: _Texts = []
        plain: list[str] = []

        def close() -> None:
            if plain:
                parts.append(TextSubstitution(text="".join(plain)))
                plain.clear()

        while self.at < len(self.text):
            letter = self.text[self.at]
            if letter in end:
                break
            if (
                letter == "\\"
                and self.at + 1 < len(self.text)
                and self.text[self.at + 1] in "$\\'\""
            ):
                plain.append(self.text[self.at + 1])
                self.at += 2
            elif self.text.startswith("$(", self.at):
                close()
                self.at += 2
                parts.append(self._substitution(depth))
            else:
                plain.append(letter)
                self.at += 1
        close()
        return parts

    def _substitution(self, depth: int) -> Substitution:
        begin = self.at
        arguments: list[_Texts] = []
        while self.at < len(self.text):
            letter = self.text[self.at]
            if letter == ")":
                self.at += 1
                return _made(arguments, self.text[begin - 2 : self.at])
            if letter.isspace():
                self.at += 1
            else:
                arguments.append(self._argument(depth))
        raise LaunchError(f"'{self.text[begin - 2 :][:60]}' is not closed: write ) at its end")

    def _argument(self, depth: int) -> _Texts:
        """Read as far as a blank or the end; what is in quotes is one argument."""
        parts: _Texts = []
        while self.at < len(self.text):
            letter = self.text[self.at]
            if letter in ") \t\n\r":
                break
            if letter in "'\"" and not parts:
                self.at += 1
                parts += self.template(letter, depth + 1)
                if self.at >= len(self.text):
                    raise LaunchError(f"a quote {letter} is not closed in '{self.text[:60]}'")
                self.at += 1
                return parts
            found = self.template(") \t\n\r", depth + 1)
            parts += found
        return parts


def _made(arguments: list[_Texts], written: str) -> Substitution:
    name = described(arguments[0]) if arguments else ""
    rest: list[Any] = list(arguments[1:])
    maker = _MAKERS.get(name)
    if maker is None:
        raise LaunchError(_unknown(name, written))
    least, most, make = maker
    if name in ("eval", "command") and len(rest) > most:
        rest = [_joined(rest)]
    if not least <= len(rest) <= most:
        counts = str(least) if least == most else f"{least} to {most}"
        raise LaunchError(f"'{written}' has {len(rest)} arguments: {name} takes {counts}")
    return make(*rest)


def _joined(arguments: list[_Texts]) -> _Texts:
    joined: _Texts = []
    for number, one in enumerate(arguments):
        joined += [TextSubstitution(text=" ")] if number else []
        joined += one
    return joined


_OF_ROS_1: Final = {
    "arg": "$(var NAME)",
    "find": "$(find-pkg-share PACKAGE)",
    "optenv": "$(env NAME DEFAULT)",
}


def _unknown(name: str, written: str) -> str:
    if name in _OF_ROS_1:
        return f"'{written}' is of ROS 1: in ROS 2 write {_OF_ROS_1[name]}"
    return f"'{written}' is no substitution that is known: var, env, eval, find-pkg-share ... are"


_MANY: Final = 64
_MAKERS: Final[dict[str, tuple[int, int, Callable[..., Substitution]]]] = {
    "var": (1, 2, lambda name, default=None: subs.LaunchConfiguration(name, default=default)),
    "env": (1, 2, lambda name, default=None: subs.EnvironmentVariable(name, default_value=default)),
    "eval": (1, 1, subs.PythonExpression),
    "command": (1, 2, lambda line, on_stderr="fail": subs.Command(line, on_stderr=on_stderr)),
    "find-pkg-share": (1, 1, subs.FindPackageShare),
    "find-pkg-prefix": (1, 1, subs.FindPackagePrefix),
    "find-pkg": (1, 1, subs.FindPackage),
    "find-exec": (1, 1, lambda name: subs.FindExecutable(name=name)),
    "exec-in-pkg": (2, 2, subs.ExecutableInPackage),
    "exec-in-package": (2, 2, subs.ExecutableInPackage),
    "dirname": (0, 0, subs.ThisLaunchFileDir),
    "filename": (0, 0, subs.ThisLaunchFile),
    "anon": (1, 1, subs.AnonName),
    "param": (1, 1, subs.ParameterSubstitution),
    "file-content": (1, 1, subs.FileContent),
    "not": (1, 1, subs.NotSubstitution),
    "and": (2, 2, subs.AndSubstitution),
    "or": (2, 2, subs.OrSubstitution),
    "any": (1, _MANY, subs.AnySubstitution),
    "all": (1, _MANY, subs.AllSubstitution),
    "equals": (2, 2, subs.EqualsSubstitution),
    "not-equals": (2, 2, subs.NotEqualsSubstitution),
    "if": (2, 3, subs.IfElseSubstitution),
    "index": (1, 1, subs.ForLoopIndex),
    "for-var": (1, 2, lambda name, default=None: subs.LaunchConfiguration(name, default=default)),
}
"""Each with the least and the most arguments."""

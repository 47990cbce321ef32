"""Substitution: a text that is known only when a launch file runs; and what is made of values."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from typing import TYPE_CHECKING, Final, TypeAlias, cast

from studio.launch.vocabulary.places import here

if TYPE_CHECKING:
    from studio.launch.vocabulary.context import LaunchContext

SomeText: TypeAlias = object
"""A text, a substitution, a path, or an iterable of these, which are joined."""

_UNKNOWN: Final = re.compile(r"\$\((?:var|unsupported) [^()]*\)")


def is_unknown(text: str) -> bool:
    """Whether a text holds a value that planning does not know."""
    return bool(_UNKNOWN.search(text))


class Substitution:
    """A text that is worked out when it is needed."""

    def __init__(self) -> None:
        self.where = here()

    def perform(self, context: LaunchContext) -> str:
        """Return the text.

        Raises:
            SubstitutionFailure: It cannot be known.
        """
        raise NotImplementedError(f"perform of {type(self).__name__}, given {context}")

    def describe(self) -> str:
        """Return it as XML launch files write it."""
        return f"$({type(self).__name__})"

    def __truediv__(self, other: object) -> Substitution:
        from studio.launch.vocabulary.substitutions import PathJoinSubstitution  # noqa: PLC0415

        return PathJoinSubstitution([self, other])

    def __rtruediv__(self, other: object) -> Substitution:
        from studio.launch.vocabulary.substitutions import PathJoinSubstitution  # noqa: PLC0415

        return PathJoinSubstitution([other, self])


class TextSubstitution(Substitution):
    """A plain text."""

    def __init__(self, *, text: str) -> None:
        super().__init__()
        if not isinstance(text, str):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise TypeError(
                f"TextSubstitution expected str object got '{type(text)}' with value '{text}' "
                "instead."
            )
        self.text = text

    def perform(self, context: LaunchContext) -> str:
        return self.text

    def describe(self) -> str:
        return self.text


def to_texts(value: SomeText) -> list[Substitution]:
    """Return a text or an iterable of texts as substitutions.

    Raises:
        TypeError: It is none, as ROS has it: a number or a bool, for example.
    """
    if isinstance(value, Substitution):
        return [value]
    if isinstance(value, str | os.PathLike):
        return [TextSubstitution(text=os.fspath(cast("str | os.PathLike[str]", value)))]
    if isinstance(value, Iterable) and not isinstance(value, bytes | dict):
        return [one for part in cast("Iterable[object]", value) for one in to_texts(part)]
    raise TypeError(
        f"Failed to normalize given item of type '{type(value)}', when only 'str' or "
        "'launch.Substitution' were expected: write it as a text, in quotes"
    )


def perform(context: LaunchContext, value: SomeText) -> str:
    """Return the joined text of a value."""
    return "".join(context.perform_substitution(one) for one in to_texts(value))


def described(value: SomeText) -> str:
    """Return a value as XML launch files write it."""
    if value is None or isinstance(value, bool | int | float):
        return str(value)
    return "".join(one.describe() for one in to_texts(value))


_TRUE: Final = frozenset({"true", "on", "1"})
_FALSE: Final = frozenset({"false", "off", "0"})


def as_bool(context: LaunchContext, value: object, what: str) -> bool:
    """Return a value as a bool, where YAML's words for it are taken.

    Raises:
        ValueError: It is none.
    """
    if isinstance(value, bool):
        return value
    text = perform(context, value).strip().lower()
    if text in _TRUE or text == "yes":
        return True
    if text in _FALSE or text == "no":
        return False
    if is_unknown(text):
        return False
    raise ValueError(f"{what} is '{text}': it must be true or false")


def as_float(context: LaunchContext, value: object) -> float:
    """Return a number or the text of one; 0.0 for what is not known yet.

    Raises:
        ValueError: It is none.
    """
    if isinstance(value, int | float):
        return float(value)
    text = perform(context, value)
    return 0.0 if is_unknown(text) else float(text)

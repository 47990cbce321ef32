"""NamePattern: a regular expression that reads every letter once, so that anybody may write it.

Python's `re` backtracks, and a short pattern can keep it busy for years. Here all alternatives are
followed at once, so the time is letters times steps.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from studio.displays.properties import Property, Value
from studio.errors import DisplayPropertyError

_STEPS_MAX: Final = 500
_LETTERS_MAX: Final = 200
_NESTED_MAX: Final = 30
_KNOWN_MAX: Final = 5000
_KINDS: Final = {
    "d": (("0", "9"),),
    "w": (("0", "9"), ("A", "Z"), ("_", "_"), ("a", "z")),
    "s": ((" ", " "), ("\t", "\r")),
}
_CONTROLS: Final = {"t": "\t", "n": "\n", "r": "\r", "f": "\f", "v": "\v"}


class _Letters(NamedTuple):
    """The letters that a step matches."""

    ranges: tuple[tuple[str, str], ...]
    others: bool = False

    def take(self, letter: str) -> bool:
        return any(low <= letter <= high for low, high in self.ranges) != self.others


class _Fork(NamedTuple):
    """Goes on at one or two steps, counted from here."""

    first: int
    second: int


class _Edge(NamedTuple):
    """Goes on at the beginning of a name only, or at its end."""

    at_end: bool


_Step = _Letters | _Fork | _Edge
_ANY: Final = _Letters((), others=True)


class NamePattern:
    """Found anywhere in a name, as std::regex_search does; without captures and back references."""

    def __init__(self, steps: list[_Step]) -> None:
        self._steps = steps
        self._known: dict[tuple[frozenset[int], bool, str], frozenset[int] | None] = {}
        """Steps after a letter, by the steps before it; None when the end was reached."""

    def is_in(self, name: str) -> bool:
        """Whether the pattern is found in a name."""
        reached: frozenset[int] | None = frozenset()
        for at, letter in enumerate(name):
            key = reached, at == 0, letter
            reached = self._known[key] if key in self._known else self._after(*key)
            if reached is None:
                return True
        return len(self._steps) in self._followed(reached, is_first=not name, is_last=True)

    def _after(
        self,
        reached: frozenset[int],
        is_first: bool,  # noqa: FBT001 - part of a key
        letter: str,
    ) -> frozenset[int] | None:
        states = self._followed(reached, is_first=is_first, is_last=False)
        onwards = None
        if len(self._steps) not in states:
            onwards = frozenset(state + 1 for state in states if self._takes(state, letter))
        if len(self._known) >= _KNOWN_MAX:
            self._known.clear()
        self._known[reached, is_first, letter] = onwards
        return onwards

    def _takes(self, state: int, letter: str) -> bool:
        step = self._steps[state]
        return isinstance(step, _Letters) and step.take(letter)

    def _followed(self, reached: frozenset[int], *, is_first: bool, is_last: bool) -> set[int]:
        """Return all steps reachable without a letter, also from the beginning."""
        states, rest = set[int](), [0, *reached]
        while rest:
            state = rest.pop()
            if state in states:
                continue
            states.add(state)
            step = self._steps[state] if state < len(self._steps) else None
            if isinstance(step, _Fork):
                rest += [state + step.first, state + step.second]
            elif isinstance(step, _Edge) and (is_last if step.at_end else is_first):
                rest.append(state + 1)
        return states


class PatternProperty(Property):
    """A text that is a pattern, or empty."""

    def checked(self, value: object) -> Value:
        """Return the pattern.

        Raises:
            DisplayPropertyError: It is none.
        """
        text = str(super().checked(value))
        pattern_of(self.name, text)
        return text


def pattern_of(name: str, text: str) -> NamePattern:
    """Read a pattern; `name` is of the property that holds it.

    Raises:
        DisplayPropertyError: It is none, or too long.
    """
    if len(text) > _LETTERS_MAX:
        raise DisplayPropertyError(name, f"takes a pattern of {_LETTERS_MAX} letters", text)
    return NamePattern(_Reader(name, text).whole())


class _Reader:
    """Reads a pattern from left to right; each part becomes steps with jumps counted from them."""

    def __init__(self, name: str, text: str) -> None:
        self._name, self._text = name, text
        self._at = self._depth = 0

    def whole(self) -> list[_Step]:
        """Return the steps of it all."""
        steps = self._choice()
        if self._at < len(self._text):
            raise self._fault("closes a bracket that was not opened")
        return steps

    def _choice(self) -> list[_Step]:
        self._depth += 1
        if self._depth > _NESTED_MAX:
            raise self._fault("has too many brackets in one another")
        steps = self._row()
        while self._takes("|"):
            other = self._row()
            steps = [
                _Fork(1, len(steps) + 2),
                *steps,
                _Fork(len(other) + 1, len(other) + 1),
                *other,
            ]
        self._depth -= 1
        return self._bounded(steps)

    def _row(self) -> list[_Step]:
        steps: list[_Step] = []
        while self._at < len(self._text) and self._text[self._at] not in "|)":
            steps = self._bounded(steps + self._repeated(self._one()))
        return steps

    def _one(self) -> list[_Step]:
        letter = self._next()
        if letter == "(":
            return self._group()
        if letter in "*+?{":
            raise self._fault(f'has a "{letter}" with nothing before it')
        if letter in "^$":
            return [_Edge(letter == "$")]
        if letter == ".":
            return [_ANY]
        if letter == "[":
            return [self._letters_in_brackets()]
        return [self._escaped() if letter == "\\" else _Letters(((letter, letter),))]

    def _group(self) -> list[_Step]:
        if self._takes("?") and not self._takes(":"):
            raise self._fault("looks ahead or behind, which is not known here")
        steps = self._choice()
        if not self._takes(")"):
            raise self._fault("opens a bracket that is not closed")
        return steps

    def _repeated(self, steps: list[_Step]) -> list[_Step]:
        while self._at < len(self._text) and self._text[self._at] in "*+?{":
            sign = self._next()
            low, high = {"*": (0, None), "+": (1, None), "?": (0, 1)}.get(sign) or self._counts()
            self._takes("?")  # Whether it is found does not depend on who takes the most.
            steps = self._times(steps, low, high)
        return steps

    def _times(self, steps: list[_Step], low: int, high: int | None) -> list[_Step]:
        length = len(steps)
        if max(low, high or 0) * (length + 1) > _STEPS_MAX:
            raise self._fault("repeats too much")
        if high is None:
            again: list[_Step] = [_Fork(1, length + 2), *steps, _Fork(-length - 1, 1)]
            return self._bounded(steps * low + again)
        maybe: list[_Step] = [_Fork(1, length + 1), *steps]
        return self._bounded(steps * low + maybe * (high - low))

    def _counts(self) -> tuple[int, int | None]:
        inner, closed, _ = self._text[self._at :].partition("}")
        low, comma, high = inner.partition(",")
        is_right = closed and _is_number(low) and (not high or _is_number(high))
        if not is_right:
            raise self._fault("has a count that is none, as {2} or {2,5} would be")
        self._at += len(inner) + 1
        least = int(low)
        most = None if comma and not high else int(high or low)
        if most is not None and most < least:
            raise self._fault("has a count that ends before it begins")
        return least, most

    def _letters_in_brackets(self) -> _Letters:
        others, ranges = self._takes("^"), list[tuple[str, str]]()
        while not self._takes("]"):
            low = self._next_in_brackets()
            is_range = self._text[self._at : self._at + 1] == "-"
            if is_range and self._text[self._at + 1 : self._at + 2] not in ("]", ""):
                self._at += 1
                high = self._next_in_brackets()
                (first, *_), (last, *_) = low, high
                if first[0] != first[1] or last[0] != last[1] or first > last:
                    raise self._fault("has a range of letters that is none")
                ranges.append((first[0], last[0]))
            else:
                ranges += low
        return _Letters(tuple(ranges), others)

    def _next_in_brackets(self) -> tuple[tuple[str, str], ...]:
        letter = self._next()
        if letter != "\\":
            return ((letter, letter),)
        escaped = self._escaped()
        if escaped.others:
            raise self._fault("has a kind of letters turned round within brackets")
        return escaped.ranges

    def _escaped(self) -> _Letters:
        letter = self._next()
        if letter.lower() in _KINDS:
            return _Letters(_KINDS[letter.lower()], letter.isupper())
        plain = _CONTROLS.get(letter, letter)
        if plain == letter and (letter.isalnum() or letter == "_"):
            raise self._fault(f'has "\\{letter}", which is not known here')
        return _Letters(((plain, plain),))

    def _next(self) -> str:
        if self._at >= len(self._text):
            raise self._fault("ends too early")
        self._at += 1
        return self._text[self._at - 1]

    def _takes(self, letter: str) -> bool:
        is_there = self._text[self._at : self._at + 1] == letter
        self._at += is_there
        return is_there

    def _bounded(self, steps: list[_Step]) -> list[_Step]:
        if len(steps) > _STEPS_MAX:
            raise self._fault("repeats too much")
        return steps

    def _fault(self, what: str) -> DisplayPropertyError:
        return DisplayPropertyError(self._name, f"is a regular expression, and this {what}", None)


def _is_number(text: str) -> bool:
    return text.isascii() and text.isdigit() and len(text) < 5

"""Comments about the values beside them: slider ranges, choices, units, help, headings.

The grammar is that of OpenSCAD's Customizer, in XML and YAML comments alike:

    [min:max]  [min:step:max]  [a, b, c]     and a unit behind it:  [0.05:0.005:0.3] m

All other text of the comment is help. `[m]` or `[rad/s]` alone only names the unit.

Which comment belongs to what:

- A comment behind a value, on its line, belongs to that value.
- Comments on lines of their own belong to the value that follows on the next line, with no blank
  line between - unless they are a heading.
- A heading is one short comment of one line, without a bracket and without a full stop, that
  stands above a blank line, or directly above two or more values on consecutive lines, or is
  framed by rules (`==== Wheels ====`). It groups the values below it, until the next heading or
  until anything that is no value (a link, a macro, an include, a nested YAML key). Values below a
  nested YAML key have that for a heading, and all comments above them are help.
- Commented-out XML and long texts such as licences are skipped.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

_HEADING_LENGTH = 60
_HELP_LENGTH = 400
_READ_LENGTH = 4000
"""Longer comments are not read."""
_BLOCK_LENGTH = 50
"""Of a longer row of comments only the last ones are read."""
_RULE = re.compile(r"^[\s=*#~_+/|-]+|[\s=*#~_+/|-]+$", re.MULTILINE)
_FRAME = re.compile(r"[=*#~_+/|-]{3,}")
_MARKUP = re.compile(r"<\s*/?[A-Za-z][^>]*>")
_LICENCE = re.compile(r"copyright|licen[sc]e|all rights reserved", re.IGNORECASE)
_BRACKET = re.compile(r"\[([^\[\]]*)\]")
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_PI = re.compile(r"([+-]?)(?:(\d+\.?\d*|\.\d+)\s*\*?\s*)?pi(?:\s*/\s*(\d+\.?\d*))?")
_UNIT_END = r"(?=$|[\s,;:.)])"
_UNITS = {
    "N m": r"N\s?m|N[*·]m",
    "N m s/rad": r"N\s?m\s?s/rad",
    "kg m^2": r"kg\s?[*·]?\s?m(?:\^2|²|2)",
    "m/s^2": r"m/s(?:\^2|²|2)",
    "rad/s^2": r"rad/s(?:\^2|²|2)",
    "rad/s": r"rad/s(?:ec)?",
    "deg/s": r"(?:deg|°)/s",
    "m/s": r"m/s(?:ec)?",
    "N/m": r"N/m",
    "rad": r"rad(?:ians?)?",
    "deg": r"deg(?:rees?)?|°",
    "mm": r"mm|millimet(?:er|re)s?",
    "cm": r"cm|centimet(?:er|re)s?",
    "km": r"km",
    "m": r"m|met(?:er|re)s?",
    "kg": r"kg|kilograms?",
    "Hz": r"Hz|hz",
    "ms": r"ms",
    "s": r"s|sec(?:onds?)?",
    "px": r"px|pixels?",
    "%": r"%|percent",
    "N": r"N",
    "V": r"V",
    "W": r"W",
    "fps": r"fps",
}
_UNIT = re.compile("|".join(f"(?P<u{n}>(?:{p}){_UNIT_END})" for n, p in enumerate(_UNITS.values())))
_UNIT_NAMES = tuple(_UNITS)


@dataclass(frozen=True, slots=True)
class Comment:
    """A comment's text without its marks; lines 1-based; `own_line`: nothing stands before it."""

    text: str
    first_line: int
    last_line: int
    own_line: bool


@dataclass(frozen=True, slots=True)
class Entry:
    """A value that comments may speak of (`is_value`), or anything else that ends a group.

    `is_grouped`: it stands under a name already (a nested YAML key); comments there are help.
    """

    first_line: int
    last_line: int
    is_value: bool = True
    is_grouped: bool = False


@dataclass(frozen=True, slots=True)
class Annotation:
    """The comments of one value; bounds in `unit`. Without any, all is empty."""

    minimum: float | None = None
    maximum: float | None = None
    step: float | None = None
    choices: tuple[str, ...] = ()
    unit: str = ""
    help: str = ""

    @property
    def gives_range(self) -> bool:
        """Whether it has more than a unit and help."""
        return self.minimum is not None or bool(self.choices)


@dataclass(frozen=True, slots=True)
class Remark:
    """The comments that belong to one entry, as written, and the heading it stands under."""

    comments: tuple[str, ...] = ()
    group: str = ""


NOTHING = Annotation()


def read_annotation(comments: Iterable[str], text: str = "") -> Annotation:
    """Read the comments of a value; the first one with a range or choices gives them.

    Args:
        comments: Their texts without marks.
        text: The value as written. Words in brackets beside a number are no choices for it.
    """
    read = [_read_comment(comment, text) for comment in comments]
    ranged = next((one for one in read if one.gives_range), NOTHING)
    unit = ranged.unit or next((one.unit for one in read if one.unit), "")
    explained = " ".join(one.help for one in read if one.help)
    return Annotation(ranged.minimum, ranged.maximum, ranged.step, ranged.choices, unit, explained)


def _read_comment(comment: str, text: str) -> Annotation:
    plain = _plain(comment)
    if not plain:
        return NOTHING
    for bracket in _BRACKET.finditer(plain):
        read = _read_bracket(bracket, text)
        if read is not None:
            unit, behind = _split_unit(plain[bracket.end() :].lstrip())
            explained = _joined(plain[: bracket.start()], behind)
            minimum, maximum, step, choices = read.minimum, read.maximum, read.step, read.choices
            return Annotation(minimum, maximum, step, choices, read.unit or unit, explained)
    return Annotation(help=plain)


def _read_bracket(bracket: re.Match[str], text: str) -> Annotation | None:
    inside = bracket[1].strip()
    if ":" in inside:
        return _read_range([part.strip() for part in inside.split(":")])
    if "," in inside:
        return _read_choices(inside.split(","), text, leading=bracket.start() == 0)
    unit, rest = _split_unit(inside)
    return Annotation(unit=unit) if unit and not rest else None


def _read_range(parts: Sequence[str]) -> Annotation | None:
    numbers = [_number(part) for part in parts]
    match numbers:
        case [float(low), float(high)] if _is_width(high - low):
            return Annotation(low, high)
        case [float(low), float(step), float(high)] if (
            _is_width(high - low) and _is_width(step) and step <= high - low
        ):
            return Annotation(low, high, step)
        case _:
            return None


def _is_width(width: float) -> bool:
    """Whether a slider can be that wide."""
    return 1e-30 < width < 1e30


def _read_choices(parts: Sequence[str], text: str, *, leading: bool) -> Annotation | None:
    """A list in the middle of a sentence only counts when the value is one of its items."""
    choices = tuple(dict.fromkeys(_unquoted(part.strip()) for part in parts if part.strip()))
    numeric = any(_number(choice) is not None for choice in choices)
    is_for_it = leading and (numeric or not _holds_numbers(text))
    if len(choices) < 2 or not (text in choices or is_for_it):
        return None
    return Annotation(choices=choices)


def _holds_numbers(text: str) -> bool:
    parts = text.split()
    return bool(parts) and all(_number(part) is not None for part in parts)


def _number(text: str) -> float | None:
    """Return a number, or a multiple of pi such as `-pi/2`."""
    if _NUMBER.fullmatch(text):
        number = float(text)
        return number if math.isfinite(number) else None
    pi = _PI.fullmatch(text)
    if pi is None or (pi[3] and not float(pi[3])):
        return None
    size = float(pi[2] or 1) * math.pi / float(pi[3] or 1)
    return -size if pi[1] == "-" else size


def _unquoted(text: str) -> str:
    return text[1:-1] if len(text) >= 2 and text[0] == text[-1] and text[0] in "\"'" else text


def _split_unit(text: str) -> tuple[str, str]:
    """Return the unit that `text` begins with, and what follows; no unit: all of it."""
    found = _UNIT.match(text)
    if found is None or found.lastgroup is None:
        return "", text
    return _UNIT_NAMES[int(found.lastgroup[1:])], text[found.end() :]


def _joined(before: str, behind: str) -> str:
    parts = (part.strip(" \t,;:-") for part in (before, behind))
    return " ".join(part for part in parts if part)


def _plain(comment: str) -> str:
    """Return a comment's text on one line; empty for commented-out XML, licences and long texts."""
    if len(comment) > _READ_LENGTH or _MARKUP.search(comment) or _LICENCE.search(comment):
        return ""
    line = " ".join(_without_rules(comment).split())
    return line if len(line) <= _HELP_LENGTH else ""


def _without_rules(comment: str) -> str:
    lines = (line.strip() for line in comment.splitlines())
    return "\n".join(_trim_rule(line) for line in lines)


def _trim_rule(line: str) -> str:
    """Drop a frame at both ends; a lone dash or slash may be part of a number or a path."""
    if _FRAME.search(line):
        return _RULE.sub("", line)
    return line.strip("*#= \t")


def attach_comments(entries: Sequence[Entry], comments: Sequence[Comment]) -> tuple[Remark, ...]:
    """Give each entry its comments and its heading, as above; both in file order."""
    own = [comment for comment in comments if comment.own_line]
    above = _blocks_above(entries, own)
    behind: dict[int, list[str]] = {}
    for comment in comments:
        if not comment.own_line:
            behind.setdefault(comment.first_line, []).append(comment.text)
    remarks: list[Remark] = []
    group = ""
    for index, entry in enumerate(entries):
        block = above[index]
        group = "" if not entry.is_value else _last_heading(entries, index, block) or group
        if not entry.is_value:
            remarks.append(Remark())
            continue
        texts = [comment.text for comment in _directly_above(entries, index, block)]
        texts += behind.get(entry.last_line, ())
        remarks.append(Remark(tuple(texts), group))
    return tuple(remarks)


def _blocks_above(entries: Sequence[Entry], own: Sequence[Comment]) -> list[list[Comment]]:
    """Return for each entry the own-line comments between the entry before it and itself."""
    blocks: list[list[Comment]] = []
    position = 0
    for entry in entries:
        start = position
        while position < len(own) and own[position].last_line <= entry.first_line:
            position += 1
        blocks.append(list(own[max(start, position - _BLOCK_LENGTH) : position]))
    return blocks


def _last_heading(entries: Sequence[Entry], index: int, block: Sequence[Comment]) -> str:
    headings = [one for one in block if _is_heading(entries, index, block, one)]
    return _plain(headings[-1].text) if headings else ""


def _directly_above(
    entries: Sequence[Entry], index: int, block: Sequence[Comment]
) -> list[Comment]:
    """Return the comments on the lines right above an entry, without a heading."""
    line = entries[index].first_line
    chosen: list[Comment] = []
    for comment in reversed(block):
        if line - comment.last_line > 1 or _is_heading(entries, index, block, comment):
            break
        chosen.insert(0, comment)
        line = comment.first_line
    return chosen


def _is_heading(
    entries: Sequence[Entry], index: int, block: Sequence[Comment], comment: Comment
) -> bool:
    if entries[index].is_grouped:
        return False
    title = _plain(comment.text)
    lines = [line for line in _without_rules(comment.text).splitlines() if line.strip()]
    if not title or len(title) > _HEADING_LENGTH or len(lines) > 1 or _BRACKET.search(title):
        return False
    if _FRAME.search(comment.text):
        return True
    if title.endswith("."):
        return False
    below = _next_line(entries, index, block, comment)
    if below - comment.last_line > 1:
        return True
    return comment is block[-1] and _begins_a_run(entries, index)


def _next_line(
    entries: Sequence[Entry], index: int, block: Sequence[Comment], comment: Comment
) -> int:
    """First line of what follows a comment of the block above entry `index`."""
    later = [one.first_line for one in block if one.first_line > comment.last_line]
    return min([*later, entries[index].first_line])


def _begins_a_run(entries: Sequence[Entry], index: int) -> bool:
    """Whether a second value follows this one on the very next line."""
    if index + 1 >= len(entries):
        return False
    following = entries[index + 1]
    return following.is_value and 0 < following.first_line - entries[index].last_line <= 1

"""Reads and writes the texts of .msg, .srv and .action files; comments are kept."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field

from studio.errors import InterfaceTextError, RosNameError
from studio.ros.names import check_package_name, split_type_name
from studio.ros.types.definitions import (
    FLOATS,
    INTEGERS,
    PRIMITIVES,
    STRINGS,
    Action,
    Constant,
    Field,
    FieldType,
    Interface,
    Literal,
    Message,
    Scalar,
    Service,
    Shape,
    messages_of,
)
from studio.ros.types.text_hints import hint_for, is_separator

_INTEGER = re.compile(r"[+-]?(0[xX][0-9a-fA-F]+|0[oO]?[0-7]+|0[bB][01]+|[0-9]+)", re.ASCII)
_INTEGER_DIGITS_MAX = 70
_TRUTH = {"true": True, "1": True, "false": False, "0": False}
# Possessive throughout: nothing is tried twice, however long a hostile text is.
_QUOTED = re.compile(r'"(?:[^"\\]|\\.)*+"|\'(?:[^\'\\]|\\.)*+\'')
_ITEM = re.compile(rf"\s*+((?:{_QUOTED.pattern})|[^,\"'\[\]]++)\s*+(,|$)")
_ESCAPE = re.compile(r"\\(.)")
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r"}
TEXT_BYTES_MAX = 1_000_000
MEMBERS_MAX = 2_000
LINE_CHARACTERS_MAX = 10_000
COUNT_MAX = 2**32 - 1
_PARTS = {"msg": 1, "srv": 2, "action": 3}
_TYPE = re.compile(
    r"(?P<base>[A-Za-z][\w/]*)(?:<=(?P<string>\d+))?(?:\[(?P<count>(?:<=)?\d*)\])?", re.ASCII
)
_LINE = re.compile(r"(?P<type>\S+)\s+(?P<name>[A-Za-z]\w*)(?P<rest>.*)", re.ASCII)
_FIELD_NAME = re.compile(r"(?!.*__)(?!.*_$)[a-z][a-z0-9_]*", re.ASCII)
# What rosidl asks for; its own pattern takes a time without end on long names.
_CONSTANT_NAME = re.compile(r"(?!.*__)(?!.*_$)[A-Z][A-Z0-9_]*", re.ASCII)
_HEADER = "std_msgs/msg/Header"


def parse_interface(name: str, text: str) -> Interface:
    """Read the text of a type by its full name, `package/msg/Type`, `/srv/` or `/action/`.

    Raises:
        InterfaceTextError: The text breaks a rule; the error has name and line.
        RosNameError: The name of the type does.
    """
    _, kind, base = split_type_name(name)
    if "_" in base:
        raise RosNameError(name, "a type is named in letters and digits, the first a capital")
    if len(text) > TEXT_BYTES_MAX or len(text.encode(errors="replace")) > TEXT_BYTES_MAX:
        raise InterfaceTextError(name, None, f"the text is longer than {TEXT_BYTES_MAX} bytes")
    parts = _split(text)
    if len(parts) != _PARTS[kind]:
        raise _wrong_parts(name, kind, parts)
    if kind == "msg":
        return _message(name, name, parts[0])
    if kind == "srv":
        request, response = (
            _message(name, f"{name}_{part}", lines)
            for part, lines in zip(("Request", "Response"), parts, strict=True)
        )
        return Service(name, request, response)
    goal, result, feedback = (
        _message(name, f"{name}_{part}", lines)
        for part, lines in zip(("Goal", "Result", "Feedback"), parts, strict=True)
    )
    return Action(name, goal, result, feedback)


def _split(text: str) -> list[list[tuple[int, str]]]:
    """Part a text at its lines of `---`; lines are numbered from 1."""
    parts: list[list[tuple[int, str]]] = [[]]
    for number, line in enumerate(text.removeprefix("\ufeff").splitlines(), start=1):
        if line.strip() == "---":
            parts.append([])
        else:
            parts[-1].append((number, line))
    return parts


def _wrong_parts(name: str, kind: str, parts: list[list[tuple[int, str]]]) -> InterfaceTextError:
    """Raise when a text has too many parts, or too few: at the line that was to part it."""
    wanted = _PARTS[kind] - 1
    meant = [(number, line) for part in parts for number, line in part if is_separator(line)]
    if len(parts) <= wanted and meant:
        number, line = meant[0]
        return InterfaceTextError(
            name, number, f'"{line.strip()[:20]}" parts nothing: write three dashes, ---'
        )
    lines = {0: "no line", 1: "one line", 2: "two lines"}[wanted]
    between = {"msg": "", "srv": " between request and response"}.get(
        kind, " between goal, result and feedback"
    )
    has = len(parts) - 1
    return InterfaceTextError(name, None, f"a .{kind} has {lines} of ---{between}, and here {has}")


class _HintedError(ValueError):
    """A rule that is broken, with what to do already in the sentence."""


@dataclass
class _Draft:
    """One message as read so far; `above` are comments that wait for a member."""

    package: str
    fields: list[Field] = field(default_factory=list[Field])
    constants: list[Constant] = field(default_factory=list[Constant])
    above: list[str] = field(default_factory=list[str])
    comment: str = ""
    lines: dict[str, int] = field(default_factory=dict[str, int])
    """The line of each member."""

    def take(self, number: int, line: str) -> None:
        """Read one line.

        Raises:
            ValueError: It breaks a rule; half a sentence describes it.
        """
        if len(line) > LINE_CHARACTERS_MAX:
            raise ValueError(f"the line is longer than {LINE_CHARACTERS_MAX} characters")
        code, comment = _split_comment(line)
        if not code.strip():
            self._note(comment)
        else:
            self._member(number, code.strip(), comment or "")

    def _note(self, comment: str | None) -> None:
        """Keep a comment for what follows; the first, set off by an empty line, is the type's."""
        if comment is not None:
            self.above.append(comment)
            return
        if not (self.comment or self.fields or self.constants):
            self.comment = "\n".join(self.above)
        self.above.clear()

    def _member(self, number: int, code: str, comment: str) -> None:
        found = _LINE.fullmatch(code)
        if not found:
            raise ValueError(f'"{code[:60]}" is no type and name')
        if len(self.fields) + len(self.constants) >= MEMBERS_MAX:
            raise ValueError(f"a type has at most {MEMBERS_MAX} fields and constants")
        kind = _field_type(found["type"], self.package)
        comments = "\n".join([*self.above, *([comment] if comment else [])])
        self.above.clear()
        rest = found["rest"].strip()
        if rest.startswith("="):
            self.constants.append(_constant(found["name"], kind, rest[1:].strip(), comments))
        elif rest and not found["rest"][0].isspace():
            raise ValueError(f'"{found["name"]}{rest[:20]}" is no name of a field')
        else:
            self.fields.append(_field(found["name"], kind, rest, comments))
        first = self.lines.setdefault(found["name"], number)
        if first != number:
            raise _HintedError(
                f"{found['name']} stands there twice, first in line {first}: rename one of them"
            )


def _message(text_name: str, name: str, lines: list[tuple[int, str]]) -> Message:
    draft = _Draft(name.partition("/")[0])
    for number, line in lines:
        try:
            draft.take(number, line)
        except (ValueError, RosNameError) as error:
            raise InterfaceTextError(text_name, number, _with_hint(error, line)) from None
    draft.take(0, "")
    return Message(name, tuple(draft.fields), tuple(draft.constants), draft.comment)


def _with_hint(error: Exception, line: str) -> str:
    reason = str(error).rstrip(".")
    if isinstance(error, _HintedError):
        return reason
    mend = hint_for(_split_comment(line)[0].strip())
    return f"{reason}: {mend}" if mend else reason


def _split_comment(line: str) -> tuple[str, str | None]:
    """Part a line at the `#` that stands in no quotes; the comment is None without one."""
    quote, place = "", 0
    while place < len(line):
        letter = line[place]
        if quote and letter == "\\":
            place += 1
        elif quote:
            quote = "" if letter == quote else quote
        elif letter in "\"'" and _opens_value(line[:place]):
            quote = letter
        elif letter == "#":
            return line[:place], line[place + 1 :].strip()
        place += 1
    return line, None


def _opens_value(before: str) -> bool:
    """Whether a quote there begins a value; an apostrophe within a bare text does not."""
    return before[-1:] in set("=[, 	") and bool(before.strip())


def _field_type(text: str, package: str) -> FieldType:
    found = _TYPE.fullmatch(text)
    if not found:
        raise ValueError(f'"{text[:60]}" is no type')
    base = _base(found["base"], package)
    string_bound = _count(found["string"]) if found["string"] else 0
    if found["string"] and (base not in STRINGS or not string_bound):
        raise ValueError(f'"{text[:60]}" is no type: only strings have a bound, from 1 on')
    count = found["count"]
    if count is None:
        return FieldType(base, string_bound=string_bound)
    if not count:
        return FieldType(base, Shape.SEQUENCE, string_bound=string_bound)
    shape = Shape.BOUNDED if count.startswith("<=") else Shape.ARRAY
    number = _count(count.removeprefix("<="))
    if not number:
        raise ValueError(f'"{text[:60]}" is no type: an array has one place at least')
    return FieldType(base, shape, number, string_bound)


def _count(digits: str) -> int:
    if not digits or len(digits) > 10 or int(digits) > COUNT_MAX:
        raise ValueError(f'"{digits[:20]}" is no length that an array may have')
    return int(digits)


def _base(text: str, package: str) -> str:
    if text in PRIMITIVES:
        return text
    if text == "Header":
        return _HEADER
    parts = text.split("/")
    if len(parts) == 1 and not text[:1].isupper():
        raise ValueError(f'"{text[:60]}" is no type')
    if len(parts) == 1:
        parts = [package, "msg", text]
    elif len(parts) == 2:
        parts = [parts[0], "msg", parts[1]]
    check_package_name(parts[0])
    name = "/".join(parts)
    if parts[1] != "msg" or "_" in split_type_name(name)[2]:
        raise ValueError(f'"{text[:60]}" is no message, and only those are fields')
    return name


def _field(name: str, kind: FieldType, default: str, comment: str) -> Field:
    if not _FIELD_NAME.fullmatch(name):
        raise ValueError(
            f'"{name[:60]}" is no name of a field: lower case letters, digits, single underscores'
        )
    return Field(name, kind, parse_literal(default, kind) if default else None, comment)


def _constant(name: str, kind: FieldType, value: str, comment: str) -> Constant:
    if not _CONSTANT_NAME.fullmatch(name):
        raise ValueError(f'"{name[:60]}" is no name of a constant: upper case letters and digits')
    if kind.nested or kind.shape is not Shape.SINGLE or kind.string_bound:
        raise ValueError(f"{name} is a {kind}, and constants are single plain values")
    if not value and kind.base not in STRINGS:
        raise ValueError(f"{name} has no value")
    return Constant(name, kind.base, parse_scalar(value, kind), comment)


def parse_literal(text: str, kind: FieldType) -> Literal:
    """Read the default of a field, or one value of a constant.

    Raises:
        ValueError: It is no value of that type; the message is half a sentence.
    """
    if kind.shape is Shape.SINGLE:
        return parse_scalar(text, kind)
    items = tuple(parse_scalar(item, kind) for item in _items(text))
    if kind.shape is Shape.ARRAY and len(items) != kind.count:
        raise ValueError(f"its default has {len(items)} values instead of {kind.count}")
    if kind.shape is Shape.BOUNDED and len(items) > kind.count:
        raise ValueError(f"its default has {len(items)} values, at most {kind.count} fit")
    return items


def parse_scalar(text: str, kind: FieldType) -> Scalar:
    """Read one value.

    Raises:
        ValueError: It is no value of that type; the message is half a sentence.
    """
    if kind.base in STRINGS:
        return _string(text, kind)
    if kind.base == "bool":
        if text.lower() not in _TRUTH:
            raise ValueError(f'"{text[:40]}" is neither true nor false')
        return _TRUTH[text.lower()]
    if kind.base in FLOATS:
        return _float(text)
    if kind.base in INTEGERS:
        return _integer(text, kind.base)
    raise ValueError(f"a {kind.base} has no default value")


def _string(text: str, kind: FieldType) -> str:
    if text[:1] in {'"', "'"}:
        if not _QUOTED.fullmatch(text):
            raise ValueError(f"the quotes of {text[:40]} do not close")
        text = _ESCAPE.sub(lambda found: _ESCAPES.get(found[1], found[1]), text[1:-1])
    if kind.string_bound and len(text) > kind.string_bound:
        raise ValueError(f'"{text[:40]}" is longer than {kind.string_bound} characters')
    return text


def _float(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise ValueError(f'"{text[:40]}" is no number') from None
    if not math.isfinite(value) or "_" in text:
        raise ValueError(f'"{text[:40]}" is no number that a text may hold')
    return value


def _integer(text: str, base: str) -> int:
    found = _INTEGER.fullmatch(text)
    if not found or len(text) > _INTEGER_DIGITS_MAX:
        raise ValueError(f'"{text[:40]}" is no whole number')
    digits = found[1].lower()
    radix = {"0x": 16, "0b": 2, "0o": 8}.get(digits[:2], 10)
    value = int(digits[2:] if radix != 10 else digits, radix)
    value = -value if text.startswith("-") else value
    low, high = INTEGERS[base]
    if not low <= value <= high:
        raise ValueError(f"{text} does not fit {base}, which goes from {low} to {high}")
    return value


def _items(text: str) -> list[str]:
    if not (text.startswith("[") and text.endswith("]")):
        raise ValueError("the default of an array stands in brackets")
    body, items, place = text[1:-1].strip(), list[str](), 0
    while place < len(body):
        found = _ITEM.match(body, place)
        if not found:
            raise ValueError(f"{body[place : place + 40]} is no list of values")
        items.append(found[1].strip())
        place = found.end()
    return items


def text_of(interface: Interface) -> str:
    """Return the text of a .msg, .srv or .action: constants, fields and defaults."""
    return "---\n".join("".join(_lines(part)) for part in messages_of(interface))


def kind_of(interface: Interface) -> str:
    """Name what a type is: msg, srv or action."""
    match interface:
        case Message():
            return "msg"
        case Service():
            return "srv"
        case Action():
            return "action"


def _lines(message: Message) -> list[str]:
    constants = message.constants
    return [
        *(f"{one.base} {one.name}={_value(one.value, quoted=False)}\n" for one in constants),
        *(f"{one.type} {one.name}{_default(one)}\n" for one in message.fields),
    ]


def _default(field: Field) -> str:
    return "" if field.default is None else f" {_literal(field.default)}"


def _literal(value: Literal) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(_value(item, quoted=True) for item in value)}]"
    return _value(value, quoted=True)


def _value(value: Scalar, *, quoted: bool) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
        return f'"{escaped}"' if quoted or value != value.strip() or "#" in value else value
    return repr(value)

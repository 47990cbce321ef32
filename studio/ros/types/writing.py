"""Types as texts again, for those that come without one: the stores' have fields only."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.ros.types.definitions import (
    Action,
    Field,
    Interface,
    Literal,
    Message,
    Scalar,
    Service,
    messages_of,
)

if TYPE_CHECKING:
    from collections.abc import Callable

_INDENT = "\t"


def text_of(interface: Interface) -> str:
    """Write what a .msg, .srv or .action would say: constants, fields and defaults."""
    return "---\n".join("".join(_lines(part, 0, None)) for part in messages_of(interface))


def full_text_of(interface: Interface, find: Callable[[str], Message]) -> str:
    """Write a type with the fields of all that it is made of below, as `ros2 interface show` does.

    Raises:
        UnknownTypeError: What `find` raises for a part that is missing.
    """
    return "---\n".join("".join(_lines(part, 0, find)) for part in messages_of(interface))


def kind_of(interface: Interface) -> str:
    """Name what a type is: msg, srv or action."""
    match interface:
        case Message():
            return "msg"
        case Service():
            return "srv"
        case Action():
            return "action"


def _lines(message: Message, level: int, find: Callable[[str], Message] | None) -> list[str]:
    indent = _INDENT * level
    lines = [
        f"{indent}{one.base} {one.name}={_value(one.value, quoted=False)}\n"
        for one in message.constants
    ]
    for field in message.fields:
        lines.append(f"{indent}{field.type} {field.name}{_default(field)}\n")
        if field.type.nested and find is not None:
            lines += _lines(find(field.type.base), level + 1, find)
    return lines


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

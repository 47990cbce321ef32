"""The text of a type and of all that it is made of, joined as rosbag2 keeps it in a bag."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.errors import UnknownTypeError
from studio.ros.profiles import NO_HASH
from studio.ros.types.definitions import messages_of
from studio.ros.types.interface_text import text_of

if TYPE_CHECKING:
    from studio.ros.types.definitions import Message
    from studio.ros.types.library import TypeLibrary

_RULE: Final = "=" * 80


def definition_text(types: TypeLibrary, type_name: str, type_hash: str = "") -> str:
    """Return the text of a message type, followed by those of the types in its fields.

    Args:
        types: Where it is looked up.
        type_name: As `std_msgs/msg/String`.
        type_hash: Of the form that is meant, as in liveliness tokens; empty: any.

    Returns:
        Empty where the type, or that form of it, is not known: rosbag2 keeps such topics as well.
    """
    try:
        if type_hash not in {"", NO_HASH} and types.hash_of(type_name) != type_hash:
            return ""
        parts = _parts(types, type_name)
    except UnknownTypeError:
        return ""
    first, *others = (_text(types, one) for one in parts)
    named = zip(parts[1:], others, strict=True)
    return first + "".join(
        f"\n{_RULE}\nMSG: {part.name.replace('/msg/', '/')}\n{text}" for part, text in named
    )


def _parts(types: TypeLibrary, type_name: str) -> list[Message]:
    """Return a type and all that it is made of, each once, itself first.

    Raises:
        UnknownTypeError: One of them is not known.
    """
    found: dict[str, Message] = {}
    waiting = [type_name]
    while waiting:
        name = waiting.pop()
        if name not in found:
            found[name] = types.find(name)
            waiting += sorted(found[name].needs(), reverse=True)
    return list(found.values())


def _text(types: TypeLibrary, message: Message) -> str:
    """Return the text as it was written where there is one of this message alone."""
    written = types.text_of(message.name)
    if written is not None and messages_of(types.interface(message.name)) == (message,):
        return written
    return text_of(message)

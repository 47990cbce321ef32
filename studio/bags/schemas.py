"""Types as a bag defines them: its schemas, split into the texts of single types."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from studio.errors import InterfaceTextError, RosNameError, UnknownTypeError
from studio.ros.names import split_type_name
from studio.ros.profiles import JAZZY, PROFILES
from studio.ros.types.files import InterfaceTexts
from studio.ros.types.interface_text import TEXT_BYTES_MAX
from studio.ros.types.library import TypeLibrary

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.bags.blocks import Definition

SCHEMA_BYTES_MAX: Final = 1_000_000
PARTS_MAX: Final = 500
"""Types in one schema."""
_RULE: Final = re.compile(r"^=+[ \t\r]*$", re.MULTILINE)
_TITLE: Final = re.compile(r"\s*(MSG|IDL):[ \t]*([\w/]{1,255})[ \t]*\r?\n?")


@dataclass(frozen=True, slots=True)
class BagTypes:
    """The types of a bag, and why some cannot be read, by their names, in a sentence each."""

    library: TypeLibrary
    faults: dict[str, str] = field(default_factory=dict[str, str])

    def trouble(self, type_name: str) -> str:
        """Return why messages of a type cannot be read; empty: they can."""
        if type_name in self.faults:
            return self.faults[type_name]
        try:
            self.library.message(type_name)
        except (UnknownTypeError, InterfaceTextError, RosNameError) as error:
            return str(error)
        return ""


def types_of(definitions: Iterable[Definition], distro: str) -> BagTypes:
    """Return the types of a bag: what it defines first, then what the studio knows.

    Args:
        definitions: What its files say; where two define one type, the first counts.
        distro: That it was recorded with; one that is unknown is taken for Jazzy.
    """
    library = TypeLibrary(distro if distro in PROFILES else JAZZY.distro)
    texts: dict[str, str] = {}
    faults: dict[str, str] = {}
    for definition in definitions:
        try:
            for name, text in _parts(definition):
                texts.setdefault(name, text)
        except InterfaceTextError as error:
            faults[definition.type_name] = str(error)
    try:
        found = library.add_sound_texts(InterfaceTexts(texts))
    except InterfaceTextError as error:
        return BagTypes(library, {**faults, **dict.fromkeys(texts, str(error))})
    return BagTypes(library, {**faults, **{name: str(error) for name, error in found.items()}})


def _parts(definition: Definition) -> Iterator[tuple[str, str]]:
    """Yield full name and text of each type in a schema.

    Raises:
        InterfaceTextError: It is too large, or in a form that is unknown here.
    """
    name = definition.type_name
    if not definition.text.strip() or not _is_message(name):
        return
    if len(definition.text) > SCHEMA_BYTES_MAX:
        raise InterfaceTextError(name, None, f"its schema has more than {SCHEMA_BYTES_MAX} bytes")
    pieces = _RULE.split(definition.text)
    if len(pieces) > PARTS_MAX:
        raise InterfaceTextError(name, None, f"its schema has more than {PARTS_MAX} parts")
    kind, owner = "IDL" if definition.encoding == "ros2idl" else "MSG", name
    for piece in pieces:
        title = _TITLE.match(piece)
        if title:
            kind, owner = title[1], _full(title[2])
        text = piece[title.end() :] if title else piece
        if len(text) > TEXT_BYTES_MAX:
            raise InterfaceTextError(owner, None, f"it has more than {TEXT_BYTES_MAX} bytes")
        if kind == "MSG" and (title or piece is pieces[0]):
            yield owner, text


def _full(name: str) -> str:
    """Return `std_msgs/msg/Header` for `std_msgs/Header`."""
    package, _, rest = name.partition("/")
    return name if "/" in rest else f"{package}/msg/{rest}"


def _is_message(name: str) -> bool:
    try:
        return split_type_name(name)[1] in ("msg", "srv", "action")
    except RosNameError:
        return False

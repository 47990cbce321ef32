# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportPrivateUsage=false
"""Real robots for tests: expanded by stock xacro in this process, and cut into parts."""

from __future__ import annotations

import contextlib
import io
import re
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import pytest
import xacro
from xacro import substitution_args

from studio.description.values import Part
from studio.problems import Place
from studio.robot.assembly import Assembly, Change
from studio.robot.xml_tree import parse_tree, plain_element

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from studio.description.elements import Element

_NAME = re.compile(r"<name>\s*([^<\s]+)\s*</name>")


@dataclass(frozen=True)
class Expanded:
    """One robot file of the corpus and the URDF that it comes to."""

    file: Path
    urdf: str

    def __str__(self) -> str:
        return self.file.name


def expanded_robots(corpus: Path) -> Iterator[Expanded]:
    """Every file that stock xacro expands without arguments to something with links."""
    packages = _packages(corpus)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(substitution_args, "_eval_find", packages.__getitem__)
        patch.setitem(substitution_args._eval_dict, "find", packages.__getitem__)
        for file in sorted((*corpus.rglob("*.xacro"), *corpus.rglob("*.urdf"))):
            urdf = _expand(file)
            if urdf is not None and "<link " in urdf:
                yield Expanded(file, urdf)


def _expand(file: Path) -> str | None:
    with contextlib.redirect_stderr(io.StringIO()):
        try:
            document: Any = xacro.process_file(str(file))
            return document.toxml()
        except Exception:  # noqa: BLE001 - whatever stock xacro does not expand is no robot here
            return None
        finally:
            xacro.filestack = xacro.macrostack = None


@cache
def _packages(corpus: Path) -> dict[str, str]:
    found: dict[str, str] = {}
    for manifest in sorted(corpus.rglob("package.xml")):
        name = _NAME.search(manifest.read_text(encoding="utf-8", errors="replace"))
        if name:
            found.setdefault(name[1], str(manifest.parent))
    return found


def parts_of(urdf: str, file: str = "robot.urdf") -> list[Part]:
    """The top-level elements of a URDF as the description room cuts them; lines count from 1."""
    parts: list[Part] = []
    counts: dict[str, int] = {}
    for number, element in enumerate(ElementTree.fromstring(urdf), start=1):
        kind = element.tag if element.tag in {"link", "joint", "material"} else "other"
        key = f"{kind}:{element.get('name', '') if kind != 'other' else number}"
        counts[key] = counts.get(key, 0) + 1
        repeat = f"#{counts[key]}" if counts[key] > 1 else ""
        element.tail = None
        parts.append(Part(key + repeat, plain_element(element), Place(file, number)))
    return parts


def element_of(xml: str) -> Element:
    """An element by its text."""
    return plain_element(parse_tree(xml))


def assembled(urdf: str) -> Change:
    """The robot of a whole URDF text."""
    return Assembled(urdf).first


class Assembled:
    """An assembly with its parts, to be changed one by one."""

    def __init__(self, urdf: str) -> None:
        self.parts = parts_of(urdf)
        self.assembly = Assembly("robot")
        self.first = self.assembly.apply(tuple(one.key for one in self.parts), self.parts)

    def change(self, key: str, xml: str) -> Change:
        """Write one element anew."""
        before = next(one for one in self.parts if one.key == key)
        return self.assembly.apply(None, [Part(key, element_of(xml), before.place)])

    def rewrite(self, urdf: str) -> Change:
        """Write everything anew."""
        self.parts = parts_of(urdf)
        return self.assembly.apply(tuple(one.key for one in self.parts), self.parts)

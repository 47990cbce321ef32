"""The interface files of a package: which there are, and whose types their texts name."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from studio.packages.sources.package_source import PackageSource

KINDS: Final = ("msg", "srv", "action")
"""Of types: also the names of their folders, and the endings of their files."""
KIND_NAMES: Final = {"msg": "message", "srv": "service", "action": "action"}
ENDINGS: Final = tuple(f".{kind}" for kind in KINDS)
PACKAGE_NEEDS: Final = (
    ("buildtool_depend", "rosidl_default_generators"),
    ("exec_depend", "rosidl_default_runtime"),
    ("member_of_group", "rosidl_interface_packages"),
)
"""What package.xml says so that code is made of interfaces, as (tag, text)."""
_FIELD_TYPE: Final = re.compile(r"([a-z][a-z0-9_]*)/(?:msg/)?[A-Z][A-Za-z0-9]*")


def interface_files(source: PackageSource) -> list[tuple[str, str]]:
    """Return (kind, name of the file) of each interface: `("msg", "msg/Quote.msg")`."""
    return [(kind, name) for kind in KINDS for name in source.below(kind, f".{kind}")]


def packages_of_interface(text: str, kind: str, own: str) -> tuple[str, ...]:
    """Return the packages whose types an interface is made of, those of its actions too."""
    found: dict[str, None] = {}
    for line in text.splitlines():
        words = line.partition("#")[0].split()
        named = _FIELD_TYPE.match(words[0]) if words else None
        if named and named[1] != own:
            found[named[1]] = None
        elif words and words[0].partition("[")[0] == "Header":
            found["std_msgs"] = None
    if kind == "action":
        found["action_msgs"] = None
    return tuple(found)

"""This machine, as far as it matters to ROS: its network interfaces and variables."""

from __future__ import annotations

import os
import socket
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import Here, Interface, short

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

_SYSTEM: Final = Path("/sys/class/net")
"""Of Linux; elsewhere only names are known."""
_UP, _LOOPBACK, _MULTICAST = 0x1, 0x8, 0x1000
_INTERFACES_MAX: Final = 64


def look_here(names: Iterable[str], environment: Mapping[str, str] = os.environ) -> Here:
    """Return interfaces, without their addresses, and those of the variables that are set."""
    return Here(
        tuple(_interface(name) for _, name in socket.if_nameindex()[:_INTERFACES_MAX]),
        {name: environment[name] for name in names if environment.get(name)},
    )


def _interface(name: str) -> Interface:
    try:
        flags = int((_SYSTEM / name / "flags").read_text(encoding="ascii"), 16)
        state = (_SYSTEM / name / "operstate").read_text(encoding="ascii").strip()
    except (OSError, ValueError):
        return Interface(short(name), None, None, None)
    is_up = bool(flags & _UP) and state != "down"
    return Interface(short(name), is_up, bool(flags & _LOOPBACK), bool(flags & _MULTICAST))

"""Messages for displays, in the bytes in which they would come."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from studio.displays.display import Received
from studio.ros.cdr import codec_of
from studio.ros.types.convert import from_dict
from studio.ros.types.library import TypeLibrary

if TYPE_CHECKING:
    from collections.abc import Mapping

TYPES = TypeLibrary("jazzy")
NOW_NS = 1_700_000_000_000_000_000
STAMP = {"sec": 12, "nanosec": 500}
STAMP_NS = 12_000_000_500
HEADER: dict[str, Any] = {"frame_id": "map", "stamp": STAMP}


def received(type_name: str, fields: Mapping[str, Any], *, little: bool = True) -> Received:
    """A message of these fields; its header is of the frame `map` unless they say otherwise."""
    return Received(
        type_name, encoded(type_name, {"header": HEADER, **fields}, little=little), NOW_NS
    )


def encoded(type_name: str, fields: Mapping[str, Any], *, little: bool = True) -> bytes:
    """The bytes of a message of these fields."""
    kind = TYPES.message(type_name)
    return bytes(codec_of(kind).encode(from_dict(kind, fields), little_endian=little))


def point(x: float, y: float, z: float) -> dict[str, float]:
    """A geometry_msgs Point or Vector3."""
    return {"x": x, "y": y, "z": z}


def pose(
    xyz: tuple[float, float, float] = (0.0, 0.0, 0.0),
    wxyz: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0),
) -> dict[str, Any]:
    """A geometry_msgs Pose."""
    w, x, y, z = wxyz
    return {"position": point(*xyz), "orientation": {"x": x, "y": y, "z": z, "w": w}}

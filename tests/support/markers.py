"""Markers as messages and as bytes, and what a display shows of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from studio.displays.display import Received
from studio.displays.markers.display import MarkerArrayDisplay
from studio.ros.cdr import Codec
from studio.ros.columns.markers import MarkerCodec
from studio.ros.types.library import TypeLibrary

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.displays.display import Display
    from studio.displays.drawing import Drawing, Shape
    from studio.displays.markers.kinds import Kind
    from studio.ros.columns.markers import MarkerColumns

TYPES = TypeLibrary("jazzy")
MARKER = TYPES.message("visualization_msgs/msg/Marker")
MARKERS = TYPES.message("visualization_msgs/msg/MarkerArray")
_POINT = TYPES.message("geometry_msgs/msg/Point")
_COLOR = TYPES.message("std_msgs/msg/ColorRGBA")
SINGLE = Codec(MARKER)
ARRAY = Codec(MARKERS)
HALF = 0.5**0.5
QUARTER_ABOUT_Z = (HALF, 0.0, 0.0, HALF)
Xyz = tuple[float, float, float]
Rgba = tuple[float, float, float, float]


def marker(  # noqa: PLR0913
    kind: Kind | int,
    number: int = 0,
    *,
    at: Xyz = (1.0, 2.0, 3.0),
    wxyz: Rgba = (1.0, 0.0, 0.0, 0.0),
    scale: Xyz = (0.5, 0.25, 2.0),
    rgba: Rgba = (1.0, 0.0, 0.2, 1.0),
    points: Iterable[Xyz] = (),
    colors: Iterable[Rgba] = (),
    frame: str = "map",
    stamp_ns: int = 0,
    lifetime_ns: int = 0,
    **fields: Any,  # noqa: ANN401
) -> Any:  # noqa: ANN401
    """One marker; other fields by their names in the message."""
    made: Any = MARKER(**{"ns": "lane", "id": number, "type": int(kind)} | fields)
    made.header.frame_id = frame
    made.header.stamp.sec, made.header.stamp.nanosec = divmod(stamp_ns, 10**9)
    made.lifetime.sec, made.lifetime.nanosec = divmod(lifetime_ns, 10**9)
    place, turn = made.pose.position, made.pose.orientation
    place.x, place.y, place.z = at
    turn.w, turn.x, turn.y, turn.z = wxyz
    made.scale.x, made.scale.y, made.scale.z = scale
    made.color.r, made.color.g, made.color.b, made.color.a = rgba
    made.points = [_POINT(x=x, y=y, z=z) for x, y, z in points]
    made.colors = [_COLOR(r=r, g=g, b=b, a=a) for r, g, b, a in colors]
    return made


def columns_of(*markers: Any) -> MarkerColumns:  # noqa: ANN401
    """Columns of an array."""
    return MarkerCodec().decode(ARRAY.encode(MARKERS(markers=list(markers))))


def array_of(*markers: Any, at_ns: int = 0, little: bool = True) -> Received:  # noqa: ANN401
    """An array as it comes from the wire."""
    raw = bytes(ARRAY.encode(MARKERS(markers=list(markers)), little_endian=little))
    return Received("visualization_msgs/msg/MarkerArray", raw, at_ns)


def single_of(one: Any, at_ns: int = 0, *, little: bool = True) -> Received:  # noqa: ANN401
    """A single marker as it comes from the wire."""
    raw = bytes(SINGLE.encode(one, little_endian=little))
    return Received("visualization_msgs/msg/Marker", raw, at_ns)


def shown(*markers: Any, little: bool = True) -> dict[str, Shape]:  # noqa: ANN401
    """What a display shows of an array, by names without the mark of the namespace."""
    display = MarkerArrayDisplay(TYPES)
    display.take(array_of(*markers, little=little))
    return shapes_in(display.draw(0))


def shapes_in(drawing: Drawing) -> dict[str, Shape]:
    """All shapes of a drawing."""
    return {
        name.split("-", 1)[1]: shape
        for placed in drawing.values()
        for name, shape in placed.shapes.items()
    }


def sentences(display: Display) -> list[str]:
    """What a display says."""
    return [status.sentence for status in display.statuses()]

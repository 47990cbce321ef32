"""Camera: the 3D scene over the picture of a camera, seen as through it, in a view of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Final

from studio.displays.display import Status, TopicRole, reading_fields
from studio.displays.drawing import NOTHING, CameraView, Placed
from studio.displays.image import IMAGE_TOPICS, SHADE_PROPERTIES, ImageDisplay
from studio.displays.pinhole import calibration_of, distortion_px, pinhole_of
from studio.displays.properties import Property, switch

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.displays.drawing import Drawing
    from studio.displays.pinhole import Pinhole
    from studio.displays.properties import Value
    from studio.ros.types.library import TypeLibrary

BACKGROUND, OVERLAY, BOTH = "background", "overlay", "background and overlay"
_VISIBILITY: Final = "Visibility"
_ROBOT, _GRID = "Robot of this document", "Grid of this document"
OWN_PARTS: Final = {_ROBOT: "robot", _GRID: "grid"}
"""What is in the scene without being one of the displays, by its name here and in the scene."""
_NEAR_M: Final = 0.01


class CameraDisplay(ImageDisplay):
    """Draws nothing in the scene itself: the page renders the scene from where the camera is."""

    KIND: ClassVar[str] = "Camera"
    DOC: ClassVar[str] = "The scene over the picture of a camera, seen as through it."
    ICON: ClassVar[str] = "camera"
    TOPICS: ClassVar[tuple[TopicRole, ...]] = IMAGE_TOPICS
    PROPERTIES: ClassVar[tuple[Property, ...]] = (
        switch(_VISIBILITY, "Shows all displays over the picture, or none.", on=True),
        Property(
            "Image Rendering", "choice", BOTH, "Where the picture is: behind, in front, or both.",
            choices=(BACKGROUND, OVERLAY, BOTH),
        ),
        Property(
            "Overlay Alpha", "number", 0.5, "How opaque the picture is in front of the scene.",
            low=0.0, high=1.0, when=("Image Rendering", (OVERLAY, BOTH)),
        ),
        Property(
            "Zoom Factor", "number", 1.0, "Below 1 more of the scene is seen, above 1 less.",
            low=0.00001, high=100_000.0,
        ),
        Property(
            "Far Plane Distance", "number", 100.0, "What is farther away is not drawn.",
            low=0.02, high=100_000.0, unit="m",
        ),
        *SHADE_PROPERTIES,
    )  # fmt: skip

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        self._names: Mapping[str, str] = {}
        self._others: dict[str, str] = {}
        super().__init__(types, values)

    def reset(self) -> None:
        """Forget the picture and the calibration."""
        self._info: Any = None
        self._pinhole: Pinhole | None = None
        super().reset()

    def beside(self, names: Mapping[str, str], own: str) -> None:
        """Take the names of the other displays, by their ids."""
        if names is not self._names:
            self._names = names
            others = {one: name for one, name in names.items() if one != own}
            if others != self._others:
                self._others = others
                self.redraw()

    def properties(self) -> tuple[Property, ...]:
        """Return those of its kind, and a switch for each other display."""
        names = dict.fromkeys((*OWN_PARTS, *self._others.values()))
        return (*self.PROPERTIES, *(self._property(f"{_VISIBILITY}/{name}") for name in names))

    def changed(self, name: str) -> None:
        """Draw again; switching all is switching each, as in RViz."""
        if name == _VISIBILITY:
            for each in [one for one in self.values if one.startswith(f"{_VISIBILITY}/")]:
                del self.values[each]
        super().changed(name)

    def statuses(self) -> tuple[Status, ...]:
        """Return why nothing can be drawn over the picture, or not where it belongs."""
        size = self.size
        if size is None:
            return ()
        if not min(size):
            return (Status("warn", "empty", "The picture has no pixels."),)
        if self._pinhole is None:
            came = "has no focal length" if self._info is not None else "has not come"
            sentence = (
                f"The camera info {came}: without it nobody knows what the camera sees, so that "
                "nothing is drawn over its picture."
            )
            return (Status("error", "no_camera_info", sentence),)
        found = (self._distorted(), self._hidden())
        return tuple(one for one in found if one is not None)

    def _take_info(self, info: Any) -> None:  # noqa: ANN401 - a sensor_msgs/CameraInfo
        with reading_fields("sensor_msgs/msg/CameraInfo"):
            same = self._info is not None and calibration_of(info) == calibration_of(self._info)
        self._info = info
        if not same:
            self.redraw()

    def _drawn(self) -> Drawing:
        size, pixels = self.size, self.pixels
        if size is None or pixels is None or not min(size):
            return NOTHING
        info = self._info
        self._pinhole = pinhole_of(info, size, "p") if info is not None else None
        at = self._pinhole
        shape = CameraView(
            image=self.shades(pixels),
            lens=None if at is None else (at.fx / size[0], at.fy / size[1], at.cx / size[0],
                                          at.cy / size[1], at.x_m, at.y_m),
            rendering=str(self.values["Image Rendering"]),
            overlay_alpha=float(self.values["Overlay Alpha"]),
            zoom=float(self.values["Zoom Factor"]),
            near_m=_NEAR_M,
            far_m=float(self.values["Far Plane Distance"]),
            hidden=self._not_shown(),
        )  # fmt: skip
        return {"camera": Placed(self.frame, self.stamp_ns, {"view": shape})}

    def _not_shown(self) -> tuple[str, ...]:
        """Return the ids of displays that are switched off in this view, and parts of the scene."""
        named = {**{part: name for name, part in OWN_PARTS.items()}, **self._others}
        every = bool(self.values[_VISIBILITY])
        return tuple(
            one for one, name in named.items()
            if not self.values.get(f"{_VISIBILITY}/{name}", every)
        )  # fmt: skip

    def _distorted(self) -> Status | None:
        size = self.size
        if self._info is None or size is None:
            return None
        px = distortion_px(self._info, size)
        if px == 0.0 or self._is_rectified():
            return None
        model = str(self._info.distortion_model)[:40] or "of no name"
        if px is None:
            sentence = f"The lens distorts ({model}), and this is not undone."
        else:
            sentence = (
                f"The lens distorts ({model}): what is drawn is up to {px:.0f} pixels beside what "
                "the picture shows. A topic with image_rect in its name has it undone."
            )
        return Status("warn", "distorted", sentence)

    def _is_rectified(self) -> bool:
        return "rect" in self.topic.rpartition("/")[2] or "/image_rect" in self.topic

    def _hidden(self) -> Status | None:
        if self.values["Image Rendering"] == OVERLAY and not self.values["Overlay Alpha"]:
            sentence = "Overlay Alpha is 0, so nothing of the picture is seen."
            return Status("warn", "transparent", sentence, ("Overlay Alpha", 0.5))
        return None

    def _property(self, name: str) -> Property:
        if not name.startswith(f"{_VISIBILITY}/"):
            return super()._property(name)
        default = self.values.get(_VISIBILITY, True)
        return Property(name, "switch", default=default, doc="Shows it over the picture.")

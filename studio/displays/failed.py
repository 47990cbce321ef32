"""A display of a config file that the studio has not: it says so, and is kept as it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.displays.display import Display, Status
from studio.displays.drawing import NOTHING

if TYPE_CHECKING:
    from studio.displays.drawing import Drawing
    from studio.ros.types.library import TypeLibrary


class FailedDisplay(Display):
    """Stands for a display of another class, as RViz's own for plug-ins that are not installed."""

    KIND = "Failed"
    DOC = "Stands for a display that is not here."
    ICON = "alert"

    def __init__(self, types: TypeLibrary, class_name: str) -> None:
        super().__init__(types)
        self.class_name = class_name

    def draw(self, now_ns: int) -> Drawing:
        """Draw nothing."""
        del now_ns
        return NOTHING

    def statuses(self) -> tuple[Status, ...]:
        """Say that there is no such display."""
        sentence = (
            f"The studio has no display {self.class_name[:80]}: it is kept, and written back as it "
            "is."
        )
        return (Status("error", "unsupported", sentence),)

"""Ghost: the recorded robot beside a document's own, transparent, as long as its bag is shown."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.protocol.displays import AddDisplay, RemoveDisplay, SetDisplayProperty

if TYPE_CHECKING:
    from studio.live.displays.document_displays import DocumentDisplays

_KIND: Final = "RobotModel"
_ALPHA: Final = 0.4


class Ghost:
    """A display like any other: who takes it away, or changes it, finds it so."""

    def __init__(self, displays: DocumentDisplays) -> None:
        self._displays = displays
        self._display = ""

    async def show(self, topic: str) -> None:
        """Show the robot that a topic describes, unless it is shown."""
        before = self._ids()
        if self._display in before:
            return
        await self._displays.add(AddDisplay(kind=_KIND, topic=topic))
        [self._display] = self._ids() - before
        alpha = SetDisplayProperty(display=self._display, name="Alpha", value=_ALPHA)
        self._displays.set_property(alpha)

    def end(self) -> None:
        """Show it no more."""
        if self._display in self._ids():
            self._displays.remove(RemoveDisplay(display=self._display))
        self._display = ""

    def _ids(self) -> set[str]:
        return {one.id for one in self._displays.kept.displays}

"""RobotModel: how a robot is shown; whoever has robots draws it as a `RobotLook` says."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np

from studio.displays.display import Received, Status, StillDisplay, TopicRole
from studio.displays.drawing import NO_TURN, NOTHING, Axes, Placed
from studio.displays.properties import Property
from studio.displays.reading import reading
from studio.errors import DisplayMessageError

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.displays.drawing import Drawing

LINKS_MAX: Final = 2000
DESCRIPTION_MAX: Final = 16_000_000
"""Letters of a description."""
_LINKS: Final = "Links/"
_ALL_LINKS: Final = "Links/All Links Enabled"
_ALPHA: Final = "/Alpha"
_SHOW_AXES: Final = "/Show Axes"
# RViz's own, of each link.
_AXIS_LENGTH_M: Final = 0.1
_AXIS_RADIUS_M: Final = 0.01


@dataclass(frozen=True, slots=True)
class RobotLook:
    """How a robot is to be drawn.

    Attributes:
        visual: Whether its looks are shown.
        collision: Whether its collision shapes are.
        mass: Whether the mass of each link is shown as a ball.
        inertia: Whether its inertia is, as a box.
        opacities: Of each link that is shown, by its name; 1 is opaque.
        frames: Where each link that is shown is, by its name: a frame on /tf.
    """

    visual: bool
    collision: bool
    mass: bool
    inertia: bool
    opacities: Mapping[str, float]
    frames: Mapping[str, str]


class RobotModelDisplay(StillDisplay):
    """Takes descriptions and settings; of the robot itself it draws nothing but axes of links.

    Attributes:
        description: The last text of the topic; empty before it came.
    """

    KIND = "RobotModel"
    DOC = "Shows a robot from its description, each link where its frame on /tf is."
    TOPICS: ClassVar[tuple[TopicRole, ...]] = (
        TopicRole("", ("std_msgs/msg/String",), latched=True, depth=1),
    )
    PROPERTIES: ClassVar[tuple[Property, ...]] = (
        Property("Visual Enabled", "switch", default=True, doc="Shows what the robot looks like."),
        Property("Collision Enabled", "switch", default=False, doc="Shows its collision shapes."),
        Property(
            "Update Interval", "number", 0.0, "Time between two updates; 0 is as often as it can.",
            low=0.0, high=3600.0, unit="s",
        ),
        Property("Alpha", "number", 1.0, "How opaque it is: 0 is not seen.", low=0.0, high=1.0),
        Property(
            "Description Source", "choice", "Topic", "Where the description comes from.",
            choices=("Topic", "File", "Document"),
        ),
        Property(
            "Description File", "text", "", "The file of the description.",
            when=("Description Source", ("File",)),
        ),
        Property("TF Prefix", "text", "", "What stands, with a slash, before the frame of a link."),
        Property(
            "Mass Properties/Mass", "switch", default=False, doc="Shows masses as balls of iron."
        ),
        Property(
            "Mass Properties/Inertia", "switch", default=False, doc="Shows inertias as boxes."
        ),
        Property(_ALL_LINKS, "switch", default=True, doc="Shows the links that are on, or none."),
    )  # fmt: skip
    SETTINGS_MAX = 4 * LINKS_MAX

    description = ""
    _links: Mapping[str, int] = MappingProxyType({})

    def properties(self) -> tuple[Property, ...]:
        """Those of the robot, and three of each link that is known."""
        of_links = (
            self._property(f"{_LINKS}{link}{part}")
            for link in self._links
            for part in ("", _ALPHA, _SHOW_AXES)
        )
        return (*self.PROPERTIES, *of_links)

    def know_links(self, links: Iterable[str]) -> None:
        """The robot was read: these are its links."""
        known = tuple(dict.fromkeys(links))[:LINKS_MAX]
        self._links = {link: number for number, link in enumerate(known)}
        self.redraw()

    def take(self, received: Received, role: str = "") -> None:
        """Keep a description.

        Raises:
            CdrError: The bytes are no such message.
            DisplayMessageError: The text is no XML, or too long.
        """
        del role
        with reading(received.type_name):
            text = str(self.decode(received).data)
        if len(text) > DESCRIPTION_MAX:
            reason = f"its text has {len(text)} letters, and {DESCRIPTION_MAX} are read"
            raise DisplayMessageError("description", reason)
        if not text.lstrip("\ufeff \t\r\n").startswith("<"):
            raise DisplayMessageError("description", "its text is no XML: choose another topic")
        self.description = text

    def reset(self) -> None:
        """Keep all: a description is as true after a jump of time as before."""

    def look(self) -> RobotLook:
        """How the robot is to be drawn."""
        shown = self._shown()
        alpha = float(self.values["Alpha"])
        return RobotLook(
            bool(self.values["Visual Enabled"]),
            bool(self.values["Collision Enabled"]),
            bool(self.values["Mass Properties/Mass"]),
            bool(self.values["Mass Properties/Inertia"]),
            {link: alpha * self._alpha_of(link) for link in shown},
            {link: self.frame_of(link) for link in shown},
        )

    def frame_of(self, link: str) -> str:
        """The frame of a link on /tf."""
        prefix = str(self.values["TF Prefix"]).strip("/")
        return f"{prefix}/{link}" if prefix else link

    def statuses(self) -> tuple[Status, ...]:
        """Why nothing of the robot is seen, as far as settings are the cause."""
        if not self.values["Alpha"]:
            words = "Alpha is 0, so nothing of the robot is seen."
            return (Status("warn", "transparent", words, ("Alpha", 1.0)),)
        parts = ("Visual Enabled", "Collision Enabled", *_MASS_PROPERTIES)
        if not any(self.values[part] for part in parts):
            words = "Neither looks nor collision shapes of the robot are switched on."
            return (Status("warn", "empty", words, ("Visual Enabled", True)),)
        if self._links and not self._shown():
            off = (
                _ALL_LINKS if not self.values[_ALL_LINKS] else f"{_LINKS}{next(iter(self._links))}"
            )
            return (Status("warn", "empty", "All links are switched off.", (off, True)),)
        return ()

    def _drawn(self) -> Drawing:
        shown = [link for link in self._shown() if self.values.get(f"{_LINKS}{link}{_SHOW_AXES}")]
        if not shown:
            return NOTHING
        axes = Axes(
            np.zeros((1, 3), np.float32),
            np.array([NO_TURN], np.float32),
            _AXIS_LENGTH_M,
            _AXIS_RADIUS_M,
        )
        return {
            f"link-{self._links[link]}": Placed(
                self.frame_of(link), 0, {"axes": axes}, follows=True
            )
            for link in shown
        }

    def _shown(self) -> tuple[str, ...]:
        if not self.values[_ALL_LINKS]:
            return ()
        return tuple(link for link in self._links if self.values.get(f"{_LINKS}{link}", True))

    def _alpha_of(self, link: str) -> float:
        return float(self.values.get(f"{_LINKS}{link}{_ALPHA}", 1.0))

    def _property(self, name: str) -> Property:
        if name == _ALL_LINKS or not name.startswith(_LINKS):
            return super()._property(name)
        if name.removeprefix(_LINKS) in self._links:
            return Property(name, "switch", default=True, doc="Shows this link.")
        if name.endswith(_ALPHA):
            return Property(name, "number", 1.0, "How opaque this link is.", low=0.0, high=1.0)
        if name.endswith(_SHOW_AXES):
            return Property(name, "switch", default=False, doc="Shows the axes of this link.")
        return Property(name, "switch", default=True, doc="Shows this link.")


_MASS_PROPERTIES: Final = ("Mass Properties/Mass", "Mass Properties/Inertia")

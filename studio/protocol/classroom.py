"""A class: who takes part in a shared studio, who has control, and how others join."""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Literal, TypeAlias

from pydantic import Field, StringConstraints

from studio.protocol.message import Command, Event, Message

NAME_MAX = 40
"""Characters of a person's name."""
PASSWORD_MAX = 200
PersonId: TypeAlias = Annotated[str, StringConstraints(max_length=64)]
Name: TypeAlias = Annotated[str, StringConstraints(min_length=1, max_length=4 * NAME_MAX)]
"""As it was typed; it is trimmed, and cut to `NAME_MAX`."""
JoinRole: TypeAlias = Literal["student", "guest"]


class StartClass(Command):
    """Let others join; a class that was paused goes on."""

    type: Literal["start_class"] = "start_class"


class PauseClass(Command):
    """Let nobody in until it is started again: who takes part is kept."""

    type: Literal["pause_class"] = "pause_class"


class EndClass(Command):
    """End it for everybody, and delete all that is kept about them."""

    type: Literal["end_class"] = "end_class"


class SetClass(Command):
    """Change how others join; what is None stays as it is."""

    type: Literal["set_class"] = "set_class"
    locked: bool | None = None
    """Whether nobody new may join."""
    password: str | None = Field(default=None, max_length=PASSWORD_MAX)
    """Asked for besides the code; empty: none is."""
    join_as: JoinRole | None = None


class RenewCode(Command):
    """Make another code and link; those who have joined stay."""

    type: Literal["renew_code"] = "renew_code"


class SetMemberRole(Command):
    """Make a person a helper, a student or a guest."""

    type: Literal["set_member_role"] = "set_member_role"
    person: PersonId
    role: Literal["helper", "student", "guest"]


class RemoveMember(Command):
    """Send a person out; their browser cannot join again until it is let in."""

    type: Literal["remove_member"] = "remove_member"
    person: PersonId


class ReadmitMember(Command):
    """Let a person in again who was sent out."""

    type: Literal["readmit_member"] = "readmit_member"
    person: PersonId


class SetName(Command):
    """Change your own name."""

    type: Literal["set_name"] = "set_name"
    name: Name


class AskControl(Command):
    """Ask for control, or no longer."""

    type: Literal["ask_control"] = "ask_control"
    asking: bool = True


class GiveControl(Command):
    """Give control to a person who is there."""

    type: Literal["give_control"] = "give_control"
    person: PersonId


class TakeControl(Command):
    """Take control: the presenter back, a helper for themselves."""

    type: Literal["take_control"] = "take_control"


class ReturnControl(Command):
    """Give control back to the presenter."""

    type: Literal["return_control"] = "return_control"


class RaiseHand(Command):
    """Raise a hand, or take it down."""

    type: Literal["raise_hand"] = "raise_hand"
    raised: bool = True


class LowerHand(Command):
    """Take down the hand of a person; of everybody, if none is named."""

    type: Literal["lower_hand"] = "lower_hand"
    person: PersonId = ""


class StopRobot(Command):
    """Stop all that pages make the robot do: publish zero velocity, cancel goals, end publications.

    Anybody may who takes part, whoever has control.
    """

    type: Literal["stop_robot"] = "stop_robot"


_Metres: TypeAlias = Annotated[float, Field(ge=-1e9, le=1e9)]
Point: TypeAlias = tuple[_Metres, _Metres, _Metres]
"""m, in the root frame of the robot."""


class Lead(Command):
    """Show others what the presenter looks at, or no longer."""

    type: Literal["lead"] = "lead"
    leading: bool


class GatherAll(Command):
    """Bring everybody to what the presenter looks at, also those who explore."""

    type: Literal["gather_all"] = "gather_all"


class Follow(Command):
    """See what the presenter looks at from now on, or no longer."""

    type: Literal["follow"] = "follow"
    following: bool


class ShowView(Command):
    """Where the presenter's camera and pointer are; they go to who follows as a binary frame.

    The frame is the byte 2, a byte that is 1 without perspective, six bytes of nothing, and
    thirteen little-endian float32: the camera's eye, what it looks at, the pointer, which is NaN
    where there is none, where the top of the picture points, and the angle that it sees.
    """

    type: Literal["show_view"] = "show_view"
    eye: Point
    target: Point
    pointer: Point | None = None
    up: Point = (0.0, 0.0, 1.0)
    """Where the top of the picture points."""
    flat: bool = False
    """Whether it is seen without perspective: then all has the size that it has at the target."""
    field: Annotated[float, Field(gt=0.0, lt=math.pi)] = math.pi / 4
    """Opening angle of the camera from below to above, rad."""


class ShowFocus(Command):
    """What the presenter has selected, points at and has open."""

    type: Literal["show_focus"] = "show_focus"
    part: Annotated[str, StringConstraints(max_length=1000)] = ""
    """Key of the selected part, as `link:base_link`; empty: none."""
    site: Annotated[str, StringConstraints(max_length=1000)] = ""
    """Of the property that is pointed at; empty: none."""
    panel: Annotated[str, StringConstraints(max_length=64)] = ""
    """The panel that was shown or clicked last."""


class Leading(Event):
    """Whether others are shown what the presenter looks at."""

    type: Literal["leading"] = "leading"
    leading: bool


class Gather(Event):
    """Follow the presenter, whatever you did before."""

    is_moment: ClassVar[bool] = True
    type: Literal["gather"] = "gather"
    document: str = ""
    """A copy that is shown to all; empty: what the presenter has open."""


class Focus(Event):
    """What the presenter has selected, points at and has open; see `show_focus`."""

    type: Literal["focus"] = "focus"
    document: str
    part: str
    site: str
    panel: str


class You(Event):
    """Who you are in the class, and what you have asked for."""

    type: Literal["you"] = "you"
    person: str
    name: str
    role: Literal["presenter", "helper", "student", "guest"]
    has_control: bool
    asking: bool = False
    hand: bool = False


class Control(Event):
    """Whether there is a class, and who has control in it."""

    type: Literal["control"] = "control"
    class_open: bool
    holder: str
    """The person; empty: the presenter."""
    name: str
    """The holder's; empty for the presenter."""
    document: str = ""
    """The shared document that a member has control of, besides ROS."""


class Stopped(Event):
    """Somebody has stopped the robot."""

    is_moment: ClassVar[bool] = True
    type: Literal["stopped"] = "stopped"
    name: str
    """Empty: the presenter."""


class MemberView(Message):
    """One person of the class."""

    person: str
    name: str
    role: Literal["helper", "student", "guest"]
    here: bool
    """Whether their page is open."""
    follows: bool = False
    """Whether a page of theirs shows what the presenter looks at."""
    removed: bool = False
    asks_s: float | None = None
    """Since when they ask for control, in seconds since the epoch."""
    hand_s: float | None = None
    """Since when their hand is raised."""


class ClassState(Event):
    """The class as the presenter and helpers see it; only to them."""

    type: Literal["class_state"] = "class_state"
    open: bool
    locked: bool
    has_password: bool
    join_as: JoinRole
    code: str
    addresses: tuple[str, ...]
    """Of the page at which others join, the one to show first."""
    link: str
    """The first address with a longer code in it."""
    qr: str
    """The link as an SVG picture; empty while nobody may join."""
    fingerprint: str
    """SHA-256 of the certificate that the studio made itself; empty: it made none."""
    only_here: bool
    """Whether no other machine reaches the studio."""
    viewers: int
    """Pages of guests who came by the link of the command line."""
    members: tuple[MemberView, ...]

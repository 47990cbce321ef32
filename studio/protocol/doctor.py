"""What the Doctor found: why something does not work, how it is known, and what mends it."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import StringConstraints

from studio.protocol.displays import Mend
from studio.protocol.message import Command, Event, Message

FINDINGS_MAX = 300
"""So many are sent; the gravest come first."""
Level: TypeAlias = Literal["error", "warn", "note"]
"""`error`: it cannot work; `warn`: it works otherwise than it seems; `note`: good to know."""
SubjectName: TypeAlias = Literal[
    "router", "network", "domain", "distribution", "versions", "bridges", "nodes", "topics",
    "types", "qos", "services", "parameters", "clocks", "rates", "stamps", "frames", "displays",
    "document", "browser",
]  # fmt: skip
ConcernKind: TypeAlias = Literal[
    "node", "topic", "service", "action", "frame", "parameter", "interface", "display", "document",
    "connection", "graphics",
]  # fmt: skip
_Text: TypeAlias = Annotated[str, StringConstraints(max_length=200)]


class LookingBrowser(Command):
    """What a browser tells of itself when it asks the Doctor."""

    renderer: _Text = ""
    """What draws its 3D view, as WebGL names it; empty: there is none, or it is not known."""
    draws_by_software: bool = False


class ExamineSystem(LookingBrowser):
    """Ask what is wrong. The Doctor listens from the first question on, and some seconds longer."""

    type: Literal["examine_system"] = "examine_system"


class GetDoctorReport(LookingBrowser):
    """Ask for the same as one HTML file."""

    type: Literal["get_doctor_report"] = "get_doctor_report"
    language: Literal["en", "de"] = "en"


class Concern(Message):
    """Something that a finding is about."""

    kind: ConcernKind
    name: str
    """A full name; of a display its id, of a parameter its node, of an interface its type; empty
    where there is one only."""


class Talk(Message):
    """Who talks to whom, as a small drawing."""

    sources: tuple[str, ...]
    """Nodes that publish or call; the first ones."""
    name: str
    """Of the topic, service or frame between them."""
    targets: tuple[str, ...]
    """Nodes that subscribe or serve; the first ones."""
    meets: bool
    """Whether anything comes through."""


class Finding(Message):
    """One thing that the Doctor found."""

    code: str
    """Kebab-case, and stable: the page explains it by this."""
    level: Level
    subject: SubjectName
    sentence: str
    """What is wrong, where, and what to do."""
    evidence: tuple[str, ...]
    """What it is concluded from, a line each; never empty."""
    about: tuple[Concern, ...]
    """What the page shows by a click; empty only where `mend` is the click."""
    mend: Mend | None = None
    line: str = ""
    """A line for a terminal that mends it, or shows more."""
    talk: Talk | None = None


class SubjectView(Message):
    """What was looked at of one subject, so that "all is well" can be trusted."""

    subject: SubjectName
    state: Literal["well", "found", "not_examined"]
    """`not_examined`: there was nothing to look at, as without a connection."""
    count: int
    """Of the things looked at: nodes, topics, frames and so on."""
    detail: str
    """What they are, in a few words; empty: the count says all."""


class SystemExamined(Event):
    """Answer to `examine_system`."""

    type: Literal["system_examined"] = "system_examined"
    request: int
    listened_s: float
    listens_s: float
    """So long the Doctor listens before it has heard enough; later answers only get better."""
    is_complete: bool
    """Whether all was asked and listened to at least once."""
    findings: tuple[Finding, ...]
    """The gravest first."""
    more: int
    """Findings that are left out."""
    subjects: tuple[SubjectView, ...]


class DoctorReport(Event):
    """Answer to `get_doctor_report`."""

    type: Literal["doctor_report"] = "doctor_report"
    request: int
    html: str

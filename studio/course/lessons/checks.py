"""The checks of lessons: what a line of a lesson asks of model, graph, page or packages."""

from __future__ import annotations

import difflib
import re
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING, Final

from studio.errors import LessonError, RosNameError
from studio.ros.names import check_full_name

if TYPE_CHECKING:
    from collections.abc import Mapping

TOLERANCE_PERCENT: Final = "10"
"""Of a rate that is given without one."""
LINE_MAX: Final = 400
"""Characters."""


class Concern(StrEnum):
    """What a check looks at."""

    MODEL = "model"
    GRAPH = "graph"
    PAGE = "page"
    PACKAGES = "packages"


@dataclass(frozen=True, slots=True)
class Check:
    """One check.

    Attributes:
        line: As it is written, less `check:`.
        kind: Names the form that it has, such as `topic_type`.
        concern: What it looks at.
        values: The words that fill the form, by name.
    """

    line: str
    kind: str
    concern: Concern
    values: Mapping[str, str] = field(hash=False)


@dataclass(frozen=True, slots=True)
class Form:
    """A form of checks: how it is written, with words in capitals for what fills it."""

    kind: str
    concern: Concern
    usage: str
    pattern: re.Pattern[str]


_WORDS: Final = {
    "NAME": r"(?P<name>[^\s/]\S*)",
    "/NAME": r"(?P<name>/\S+)",
    "/NODE": r"(?P<node>/\S+)",
    "COUNT": r"(?P<count>\d{1,6})",
    "VALUE": r"(?P<value>\S.*)",
    "JOINT_TYPE": r"(?P<type>fixed|revolute|continuous|prismatic|planar|floating)",
    "TYPE": r"(?P<type>\w+(?:/\w+){1,2})",
    "RATE": r"(?P<rate>\d{1,6}(?:\.\d{1,6})?)",
    "PERCENT": r"(?P<percent>\d{1,6}(?:\.\d{1,6})?)",
    "RELIABILITY": r"(?P<reliability>reliable|best_effort)",
    "DURABILITY": r"(?P<durability>volatile|transient_local)",
    "RESPONSE": r"(?P<response>\{.*\})",
    "REQUEST": r"(?P<request>\{.*\})",
    "PARENT": r"(?P<parent>\S+)",
    "CHILD": r"(?P<child>\S+)",
    "PANEL": r"(?P<panel>[a-z_]+)",
}


def _form(kind: str, concern: Concern, usage: str) -> Form:
    """Make a form of its usage: capitals are filled in, what is in brackets may be left out."""
    needed, _, more = usage.partition("[")
    pattern = _filled(needed) + (f"(?:{_filled(more.rstrip(']'))})?" if more else "")
    return Form(kind, concern, usage, re.compile(pattern))


def _filled(usage: str) -> str:
    return " ".join(_WORDS.get(word) or _plain(word) for word in usage.split(" "))


def _plain(word: str) -> str:
    """Return a pattern for a word; `(s)` and `ren` may be left out."""
    if word == "children":
        return "child(?:ren)?"
    return re.escape(word).replace(r"\(s\)", "s?")


FORMS: Final = tuple(
    _form(*row)
    for row in (
        ("property", Concern.MODEL, "property NAME is VALUE"),
        ("argument", Concern.MODEL, "argument NAME is VALUE"),
        ("children", Concern.MODEL, "link NAME has COUNT children"),
        ("link", Concern.MODEL, "link NAME is there"),
        ("joint", Concern.MODEL, "joint NAME is JOINT_TYPE"),
        ("no_errors", Concern.MODEL, "no errors"),
        ("node", Concern.GRAPH, "node /NAME runs"),
        ("topic_type", Concern.GRAPH, "topic /NAME is of TYPE"),
        ("publishers", Concern.GRAPH, "topic /NAME has COUNT publisher(s)"),
        ("subscriptions", Concern.GRAPH, "topic /NAME has COUNT subscription(s)"),
        ("rate", Concern.GRAPH, "topic /NAME comes at RATE Hz[ ± PERCENT %]"),
        ("published", Concern.GRAPH, "topic /NAME is published RELIABILITY[ DURABILITY]"),
        ("subscribed", Concern.GRAPH, "topic /NAME is subscribed RELIABILITY[ DURABILITY]"),
        ("service_type", Concern.GRAPH, "service /NAME is of TYPE"),
        ("servers", Concern.GRAPH, "service /NAME has COUNT server(s)"),
        ("answers", Concern.GRAPH, "service /NAME answers RESPONSE to REQUEST"),
        ("action_type", Concern.GRAPH, "action /NAME is of TYPE"),
        ("parameter", Concern.GRAPH, "parameter /NODE NAME is VALUE"),
        ("tf", Concern.GRAPH, "tf leads from PARENT to CHILD"),
        ("opened", Concern.PAGE, "opened PANEL"),
        ("package", Concern.PACKAGES, "package NAME has no problems"),
    )
)
_OF_TYPE: Final = {"topic_type": "msg", "service_type": "srv", "action_type": "action"}


def read_check(line: str) -> Check:
    """Read one check.

    Args:
        line: Less `check:`, such as `topic /chatter comes at 2 Hz ± 10 %`.

    Raises:
        LessonError: It has none of the forms.
    """
    line = _spaced(line)
    if len(line) > LINE_MAX:
        raise LessonError(f"A check has {LINE_MAX} characters at most: make {line[:40]!r} shorter.")
    for form in FORMS:
        if match := form.pattern.fullmatch(line):
            found = {name: value for name, value in match.groupdict().items() if value is not None}
            return Check(line, form.kind, form.concern, _completed(form.kind, found))
    raise LessonError(f"{line!r} is no check: write it as `{_nearest(line)}`.")


def _spaced(line: str) -> str:
    """Return a line with one blank between words, and around the signs of a rate."""
    if " Hz" in line:
        line = re.sub(r"±|\+/?-", " ± ", line).replace("%", " %")
    return " ".join(line.split())


def _completed(kind: str, values: dict[str, str]) -> dict[str, str]:
    if part := _OF_TYPE.get(kind):
        package, *between, name = values["type"].split("/")
        if between not in ([], [part]):
            raise LessonError(
                f"{values['type']!r} is no {part} type: write it as `{package}/{part}/{name}`."
            )
        values["type"] = f"{package}/{part}/{name}"
    for name in (values.get("name", ""), values.get("node", "")):
        if name.startswith("/"):
            _check_name(name)
    if kind == "rate":
        values.setdefault("percent", TOLERANCE_PERCENT)
        if not float(values["rate"]):
            raise LessonError("A rate is more than 0 Hz: nothing comes at 0 Hz.")
    return values


def _check_name(name: str) -> None:
    try:
        check_full_name(name)
    except RosNameError as error:
        raise LessonError(str(error)) from None


def _nearest(line: str) -> str:
    """Return the usage of the form that a line is most like."""
    words = line.split(" ")

    def likeness(usage: str) -> tuple[bool, int, float]:
        named = usage.split(" ")
        alike = difflib.SequenceMatcher(None, line, usage).ratio()
        return named[0] == words[0], len({*named} & {*words}), alike

    return max((form.usage for form in FORMS), key=likeness)

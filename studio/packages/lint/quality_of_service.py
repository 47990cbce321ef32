"""Checks of QoS between nodes of a workspace: what one asks, and the other offers."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.packages.lint.checked import WARNING, CheckedPackage, found

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.packages.sources.python_file import PythonFile
    from studio.problems import Problem

ENDS_MAX: Final = 2_000
_PLACES: Final = {"create_publisher": 2, "create_subscription": 3}


class _End(NamedTuple):
    """A publisher or subscription whose topic and QoS stand in the text."""

    makes: str
    topic: str
    is_reliable: bool
    is_latched: bool
    python: PythonFile
    call: ast.Call


def findings(checked: CheckedPackage) -> Iterator[Problem]:
    """Yield subscriptions that can get nothing of a publisher of their topic."""
    own = list(_ends(checked))
    wanted = {one.topic for one in own if one.makes == "create_subscription"}
    if not wanted:
        return
    offered: list[_End] = []
    for source in checked.packages.values():
        other = CheckedPackage(source, checked.packages, checked.known)
        offered += [one for one in _ends(other) if one.makes == "create_publisher"][:ENDS_MAX]
    for one in own:
        if one.makes != "create_subscription":
            continue
        for publisher in (each for each in offered if each.topic == one.topic):
            what = ""
            if one.is_reliable and not publisher.is_reliable:
                what = "reliable delivery, and the publisher offers best effort"
            elif one.is_latched and not publisher.is_latched:
                what = "transient local durability, and the publisher offers volatile"
            if what:
                at = one.python.span(one.call)[0]
                where = publisher.python.source.place(publisher.python.span(publisher.call)[0])
                file = where.file.rpartition("/")[2]
                sentence = (
                    f"This subscription of {one.topic} asks for {what} ({file}, "
                    f"line {where.line}): no message comes through."
                )
                yield found(WARNING, "qos-mismatch", sentence, one.python.source, at)
                break


def _ends(checked: CheckedPackage) -> Iterator[_End]:
    for python in checked.python_files:
        profiles = _profiles(python)
        for call in python.nodes:
            if not isinstance(call, ast.Call):
                continue
            makes = getattr(call.func, "attr", "")
            if makes not in _PLACES:
                continue
            topic = _argument(call, 1, "topic")
            qos = _profile(_argument(call, _PLACES[makes], "qos_profile"), profiles)
            if isinstance(topic, ast.Constant) and isinstance(topic.value, str) and qos is not None:
                yield _End(makes, topic.value.lstrip("/"), *qos, python, call)


def _argument(call: ast.Call, place: int, keyword: str) -> ast.expr | None:
    named = next((one.value for one in call.keywords if one.arg == keyword), None)
    return named or (call.args[place] if len(call.args) > place else None)


def _profiles(python: PythonFile) -> dict[str, tuple[bool, bool]]:
    """Return the profiles by the name of what they are assigned to; a name of several is none."""
    found_profiles: dict[str, tuple[bool, bool]] = {}
    twice: set[str] = set()
    for node in python.nodes:
        if isinstance(node, ast.Assign) and len(node.targets) == 1:
            target = node.targets[0]
            name = getattr(target, "attr", getattr(target, "id", ""))
            profile = _made(node.value)
            if profile is not None and isinstance(name, str):
                twice |= {name} & found_profiles.keys()
                found_profiles[name] = profile
    return {name: one for name, one in found_profiles.items() if name not in twice}


def _profile(
    node: ast.expr | None, profiles: dict[str, tuple[bool, bool]]
) -> tuple[bool, bool] | None:
    """Return whether a profile is reliable, and transient local; None if that is not plain."""
    if isinstance(node, ast.Constant) and isinstance(node.value, int):
        return True, False
    name = getattr(node, "attr", getattr(node, "id", None))
    if name == "qos_profile_sensor_data":
        return False, False
    if isinstance(name, str):
        return profiles.get(name)
    return _made(node) if node is not None else None


def _made(node: ast.expr) -> tuple[bool, bool] | None:
    if not isinstance(node, ast.Call) or getattr(node.func, "id", "") != "QoSProfile":
        return None
    words = {one.arg: getattr(one.value, "attr", None) for one in node.keywords}
    if "reliability" in words and words["reliability"] is None:
        return None
    if "durability" in words and words["durability"] is None:
        return None
    is_reliable = "BEST_EFFORT" not in str(words.get("reliability"))
    return is_reliable, "TRANSIENT_LOCAL" in str(words.get("durability"))


WHY: Final = {
    "qos-mismatch": {
        "en": "A subscription must not ask for more than its publisher offers. DDS connects them "
        "then not at all, without an error; rmw_zenoh may.",
        "de": "Eine Subscription darf nicht mehr verlangen, als der Publisher bietet. DDS "
        "verbindet sie sonst gar nicht, ohne Fehlermeldung; rmw_zenoh vielleicht doch.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""

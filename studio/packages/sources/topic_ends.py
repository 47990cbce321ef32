"""The publishers and subscriptions that a Python file makes, as far as their QoS is written out."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.packages.sources.python_file import last_name

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.packages.sources.python_file import PythonFile

_PLACES: Final = {"create_publisher": 2, "create_subscription": 3}


class TopicEnd(NamedTuple):
    """A publisher or subscription whose topic and QoS stand in the text."""

    publishes: bool
    topic: str
    is_reliable: bool
    is_latched: bool
    python: PythonFile
    call: ast.Call


def topic_ends(python: PythonFile) -> Iterator[TopicEnd]:
    """Yield those of a file."""
    calls = [one for one in python.nodes if isinstance(one, ast.Call)]
    made = [one for one in calls if getattr(one.func, "attr", "") in _PLACES]
    profiles = _profiles(python) if made else {}
    for call in made:
        makes = last_name(call.func)
        topic = _argument(call, 1, "topic")
        qos = _profile(_argument(call, _PLACES[makes], "qos_profile"), profiles)
        if isinstance(topic, ast.Constant) and isinstance(topic.value, str) and qos is not None:
            publishes = makes == "create_publisher"
            yield TopicEnd(publishes, topic.value.lstrip("/"), *qos, python, call)


def _argument(call: ast.Call, place: int, keyword: str) -> ast.expr | None:
    named = next((one.value for one in call.keywords if one.arg == keyword), None)
    return named or (call.args[place] if len(call.args) > place else None)


def _profiles(python: PythonFile) -> dict[str, tuple[bool, bool]]:
    """Return the profiles by the name of what they are assigned to; a name of several is none."""
    found: dict[str, tuple[bool, bool]] = {}
    twice: set[str] = set()
    for node in python.nodes:
        if isinstance(node, ast.Assign) and len(node.targets) == 1:
            target = node.targets[0]
            name = last_name(target)
            profile = _made(node.value)
            if profile is not None:
                twice |= {name} & found.keys()
                found[name] = profile
    return {name: one for name, one in found.items() if name not in twice}


def _profile(
    node: ast.expr | None, profiles: dict[str, tuple[bool, bool]]
) -> tuple[bool, bool] | None:
    """Return whether a profile is reliable, and transient local; None if that is not plain."""
    if isinstance(node, ast.Constant) and isinstance(node.value, int):
        return True, False
    name = last_name(node)
    if name == "qos_profile_sensor_data":
        return False, False
    if name:
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

"""Files of `--qos-profile-overrides-path`: quality of service by topic, as ros2 bag reads them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, cast

import yaml

from studio.errors import SettingsError
from studio.ros.duration import INFINITE, NANOSECONDS, Duration
from studio.ros.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)

if TYPE_CHECKING:
    from collections.abc import Mapping
    from enum import IntEnum
    from pathlib import Path

BYTES_MAX: Final = 1_000_000
_REST_NS_MAX: Final = 2**32 - 1
_DEPTH_MAX: Final = 2**31
_POLICIES: Final[Mapping[str, type[IntEnum]]] = {
    "history": HistoryPolicy,
    "reliability": ReliabilityPolicy,
    "durability": DurabilityPolicy,
    "liveliness": LivelinessPolicy,
}
_DURATIONS: Final = ("deadline", "lifespan", "liveliness_lease_duration")
_FLAG: Final = "avoid_ros_namespace_conventions"
_KEYS: Final = (*_POLICIES, "depth", *_DURATIONS, _FLAG)


def read_qos_overrides(path: Path) -> dict[str, QoSProfile]:
    """Read a file: a mapping of topics, of each the policies that are to be others.

    Raises:
        SettingsError: It cannot be read, or says what no profile takes.
    """
    try:
        with path.open("rb") as file:
            data = file.read(BYTES_MAX + 1)
    except OSError as error:
        raise SettingsError(f"{path} cannot be read: {error.strerror}.") from error
    if len(data) > BYTES_MAX:
        raise SettingsError(f"{path} is larger than {BYTES_MAX} bytes.")
    return _overrides(data.decode(errors="replace"), str(path))


def _overrides(text: str, source: str) -> dict[str, QoSProfile]:
    try:
        read: object = yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise SettingsError(f"{source} is no YAML: {error}") from None
    except RecursionError:
        raise SettingsError(f"{source} is nested too deeply.") from None
    found: dict[str, QoSProfile] = {}
    for topic, policies in _mapping(read, f"{source}: topics").items():
        name = topic if topic.startswith("/") else f"/{topic}"
        found[name] = _profile(_mapping(policies, f"{source}: {topic}"), f"{source}: {topic}")
    return found


def _mapping(value: object, where: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise SettingsError(f"{where} must be a mapping, name: value.")
    return {str(key): one for key, one in cast("dict[Any, Any]", value).items()}


def _profile(policies: Mapping[str, Any], where: str) -> QoSProfile:
    if not {"history", "depth"} & policies.keys():
        raise SettingsError(f"{where} gives neither history nor depth: ros2 wants one of them.")
    return QoSProfile(**{key: _value(key, one, where) for key, one in policies.items()})


def _value(key: str, value: object, where: str) -> Any:  # noqa: ANN401 - as many as a profile has
    if key in _POLICIES:
        return _policy(key, value, where)
    if key in _DURATIONS:
        return _duration(value, f"{where}: {key}")
    if key == "depth" and isinstance(value, int) and 0 <= value < _DEPTH_MAX:
        return value
    if key == _FLAG and isinstance(value, bool):
        return value
    if key in _KEYS:
        raise SettingsError(f"{where}: {key} cannot be {value!r:.40}.")
    raise SettingsError(f"{where}: {key} is no policy, those are {', '.join(_KEYS)}.")


def _policy(key: str, value: object, where: str) -> IntEnum:
    policies = _POLICIES[key]
    found = policies.__members__.get(str(value).upper())
    if found is None:
        known = ", ".join(one.lower() for one in policies.__members__ if one != "UNKNOWN")
        raise SettingsError(f"{where}: {key} cannot be {value!r:.40}, but {known}.")
    return found


def _duration(value: object, where: str) -> Duration:
    parts = _mapping(value, where)
    if parts.keys() != {"sec", "nsec"}:
        raise SettingsError(f"{where} needs both sec and nsec.")
    seconds, rest_ns = parts["sec"], parts["nsec"]
    if not (isinstance(seconds, int) and isinstance(rest_ns, int)):
        raise SettingsError(f"{where}: sec and nsec are whole numbers.")
    if seconds < 0 or not 0 <= rest_ns <= _REST_NS_MAX:
        raise SettingsError(f"{where} is below zero, or nsec is more than it holds.")
    span = Duration(nanoseconds=seconds * NANOSECONDS + rest_ns)
    return Duration() if span >= INFINITE else span

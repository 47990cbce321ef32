"""`metadata.yaml` of rosbag2, versions 1 to 9: read within bounds, and what it says of QoS."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any, Final, cast

import yaml

from studio.errors import BagNotReadableError
from studio.ros.duration import Duration
from studio.ros.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from enum import IntEnum
    from pathlib import Path

METADATA_NAME: Final = "metadata.yaml"
METADATA_BYTES_MAX: Final = 64 * 2**20
QOS_BYTES_MAX: Final = 256 * 2**10
PROFILES_MAX: Final = 64
FILES_MAX: Final = 10_000
VERSION_MAX: Final = 9
_DEPTH_MAX: Final = 50
_FOREVER_S: Final = 2**31 - 1
"""What rosbag2 writes for a span without end is this, or more."""
_Fields = dict[str, Any]


@dataclass(frozen=True, slots=True)
class TopicMetadata:
    """A topic as `metadata.yaml` lists it."""

    name: str
    type_name: str
    encoding: str = "cdr"
    type_hash: str = ""
    qos: tuple[QoSProfile, ...] = ()
    count: int = 0


@dataclass(frozen=True, slots=True)
class BagMetadata:
    """What `metadata.yaml` says of a bag.

    Attributes:
        files: Names of its files in the folder.
        compression_mode: `file`, `message`, or empty for neither.
        begin_ns: When the first message came; 0 without one.
        duration_ns: From it to the last.
    """

    version: int
    storage: str
    files: tuple[str, ...]
    begin_ns: int = 0
    duration_ns: int = 0
    count: int = 0
    topics: tuple[TopicMetadata, ...] = ()
    compression_format: str = ""
    compression_mode: str = ""
    distro: str = ""
    custom_data: dict[str, str] = field(default_factory=dict[str, str])


def read_metadata(file: Path) -> BagMetadata:
    """Read `metadata.yaml`.

    Raises:
        BagNotReadableError: It is too large, no YAML, or says something else than it should.
    """
    try:
        with file.open("rb") as stream:
            data = stream.read(METADATA_BYTES_MAX + 1)
    except OSError as error:
        raise BagNotReadableError(str(file), error.strerror or type(error).__name__) from None
    if len(data) > METADATA_BYTES_MAX:
        raise BagNotReadableError(str(file), f"it is larger than {METADATA_BYTES_MAX} bytes")
    try:
        return metadata_of(data.decode(errors="replace"))
    except ValueError as error:
        raise BagNotReadableError(str(file), str(error)) from None


def metadata_of(text: str) -> BagMetadata:
    """Read the text of a `metadata.yaml`.

    Raises:
        ValueError: It is no YAML, or says something else than it should.
    """
    whole = _loaded(text)
    try:
        fields = cast("_Fields", whole)
        return _metadata(fields.get("rosbag2_bagfile_information", fields))
    except (TypeError, KeyError, AttributeError, OverflowError) as error:
        raise ValueError(f"it lacks something, or has it in another form ({error!s:.60})") from None


if TYPE_CHECKING:
    _BaseLoader = yaml.SafeLoader
else:
    _BaseLoader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class _Loader(_BaseLoader):
    """Refuses `<<`, which no recorder writes: merges of merges take any amount of memory."""

    def flatten_mapping(self, node: yaml.MappingNode) -> None:
        """Leave a mapping as it is."""


def _loaded(text: str) -> object:
    try:
        _check_depth(text)
        return yaml.load(text, Loader=_Loader)
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        reason = str(error).partition("\n")[0]
        raise ValueError(f"it is no YAML ({reason:.100})") from None


def _check_depth(text: str) -> None:
    """Check that values are not nested deeper than any recorder does: it would end the process.

    Raises:
        ValueError: They are.
    """
    depth = 0
    parse = cast("Callable[..., Iterator[yaml.Event]]", yaml.parse)  # pyright: ignore[reportUnknownMemberType]
    for event in parse(text, Loader=_Loader):
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
            if depth > _DEPTH_MAX:
                raise ValueError(f"its values are nested deeper than {_DEPTH_MAX}")
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1


def _metadata(about: _Fields) -> BagMetadata:
    version = int(about["version"])
    if version > VERSION_MAX:
        raise ValueError(f"it is of version {version}, newer than any that is known here")
    files = [PurePosixPath(_word(one)).name for one in about["relative_file_paths"][:FILES_MAX]]
    mode = _word(about.get("compression_mode") or "").lower()
    custom = about.get("custom_data")
    return BagMetadata(
        version,
        _word(about["storage_identifier"]),
        tuple(files),
        int(about["starting_time"]["nanoseconds_since_epoch"]),
        int(about["duration"]["nanoseconds"]),
        int(about["message_count"]),
        tuple(_topic(one) for one in about["topics_with_message_count"] or ()),
        _word(about.get("compression_format") or ""),
        "" if mode == "none" else mode,
        _word(about.get("ros_distro") or ""),
        {_word(key): _word(value) for key, value in custom.items()} if custom else {},
    )


def _word(value: object) -> str:
    """Return a text, or what YAML takes for a number; lists of references to lists are endless."""
    if isinstance(value, list | tuple | dict | set):
        raise TypeError("a text is a list")
    return str(value)


def _topic(entry: _Fields) -> TopicMetadata:
    about = entry["topic_metadata"]
    return TopicMetadata(
        _word(about["name"]),
        _word(about["type"]),
        _word(about.get("serialization_format", "cdr")),
        _word(about.get("type_description_hash") or ""),
        profiles_of(about.get("offered_qos_profiles") or ""),
        int(entry["message_count"]),
    )


def profiles_of(offered: object) -> tuple[QoSProfile, ...]:
    """Return QoS profiles as bags have them: a list, or since longer a text of one; () if wrong."""
    try:
        entries = _entries(offered) if isinstance(offered, str) else offered
        if not isinstance(entries, list):
            return ()
        found = cast("list[_Fields]", entries)[:PROFILES_MAX]
        return tuple(_profile(one) for one in found)
    except (ValueError, TypeError, KeyError, AttributeError, OverflowError):
        return ()


@lru_cache(1_000)
def _entries(text: str) -> object:
    """Read a text of QoS; most topics of a bag have the same."""
    return _loaded(text) if 0 < len(text) <= QOS_BYTES_MAX else []


def _profile(entry: _Fields) -> QoSProfile:
    return QoSProfile(
        history=_policy(HistoryPolicy, entry["history"]),
        depth=int(entry["depth"]),
        reliability=_policy(ReliabilityPolicy, entry["reliability"]),
        durability=_policy(DurabilityPolicy, entry["durability"]),
        lifespan=_span(entry["lifespan"]),
        deadline=_span(entry["deadline"]),
        liveliness=_policy(LivelinessPolicy, entry["liveliness"]),
        liveliness_lease_duration=_span(entry["liveliness_lease_duration"]),
        avoid_ros_namespace_conventions=bool(entry["avoid_ros_namespace_conventions"]),
    )


def _policy(kind: type[IntEnum], value: object) -> Any:  # noqa: ANN401
    """Return a policy by its number, as until version 8, or by its name."""
    try:
        return kind(value) if isinstance(value, int) else kind[_word(value).upper()]
    except (KeyError, ValueError):
        return kind["UNKNOWN"]


def _span(entry: _Fields) -> Duration:
    seconds, nanoseconds = int(entry["sec"]), int(entry["nsec"])
    return (
        Duration() if seconds >= _FOREVER_S else Duration(seconds=seconds, nanoseconds=nanoseconds)
    )

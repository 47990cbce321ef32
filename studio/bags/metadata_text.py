"""The `metadata.yaml` of a rosbag2 folder, in the form of version 9, as Jazzy writes it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import yaml

from studio.ros.duration import INFINITE, NANOSECONDS, Duration

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from studio.bags.recording import RecordedTopic
    from studio.ros.qos import QoSProfile

METADATA_NAME: Final = "metadata.yaml"
VERSION: Final = 9
_NEVER_NS: Final = 2**63 - 1
"""When a bag without messages begins."""


@dataclass(slots=True)
class Span:
    """How many messages there are, and when the first and the last came, ns since the epoch."""

    count: int = 0
    begin_ns: int = _NEVER_NS
    end_ns: int = 0

    def add(self, at_ns: int) -> None:
        """Count a message."""
        self.count += 1
        self.begin_ns = min(self.begin_ns, at_ns)
        self.end_ns = max(self.end_ns, at_ns)

    def join(self, other: Span) -> None:
        """Count the messages of another."""
        self.count += other.count
        self.begin_ns = min(self.begin_ns, other.begin_ns)
        self.end_ns = max(self.end_ns, other.end_ns)


@dataclass(frozen=True, slots=True)
class BagDescription:
    """What a `metadata.yaml` says; files by name with what is in each, in their order."""

    storage: str
    files: Mapping[str, Span]
    topics: Sequence[tuple[RecordedTopic, int]]
    compression_format: str = ""
    compression_mode: str = ""
    custom_data: Mapping[str, str] = field(default_factory=dict[str, str])
    distro: str = ""


def metadata_text(bag: BagDescription) -> str:
    """Write the whole file."""
    return _dump({"rosbag2_bagfile_information": _information(bag)})


def information_text(bag: BagDescription) -> str:
    """Write what stands below the one key of the file, as storage files keep it, too."""
    return _dump(_information(bag))


def qos_text(profiles: Sequence[QoSProfile]) -> str:
    """Write the profiles of a topic as storage files keep them; empty for none."""
    return _dump([_qos(one) for one in profiles]).strip() if profiles else ""


def _information(bag: BagDescription) -> dict[str, Any]:
    whole = Span()
    for span in bag.files.values():
        whole.join(span)
    return {
        "version": VERSION,
        "storage_identifier": bag.storage,
        **_times(whole),
        "message_count": whole.count,
        "topics_with_message_count": [
            {"topic_metadata": _topic(topic), "message_count": count} for topic, count in bag.topics
        ],
        "compression_format": bag.compression_format,
        "compression_mode": bag.compression_mode,
        "relative_file_paths": list(bag.files),
        "files": [
            {"path": name, **_times(span), "message_count": span.count}
            for name, span in bag.files.items()
        ],
        "custom_data": dict(bag.custom_data) or None,
        "ros_distro": bag.distro,
    }


def _times(span: Span) -> dict[str, Any]:
    return {
        "duration": {"nanoseconds": max(0, span.end_ns - span.begin_ns) if span.count else 0},
        "starting_time": {"nanoseconds_since_epoch": span.begin_ns},
    }


def _topic(topic: RecordedTopic) -> dict[str, Any]:
    return {
        "name": topic.name,
        "type": topic.type_name,
        "serialization_format": topic.encoding,
        "offered_qos_profiles": [_qos(one) for one in topic.qos],
        "type_description_hash": topic.type_hash,
    }


def _qos(qos: QoSProfile) -> dict[str, Any]:
    return {
        "history": qos.history.name.lower(),
        "depth": qos.depth,
        "reliability": qos.reliability.name.lower(),
        "durability": qos.durability.name.lower(),
        "deadline": _duration(qos.deadline),
        "lifespan": _duration(qos.lifespan),
        "liveliness": qos.liveliness.name.lower(),
        "liveliness_lease_duration": _duration(qos.liveliness_lease_duration),
        "avoid_ros_namespace_conventions": qos.avoid_ros_namespace_conventions,
    }


def _duration(span: Duration) -> dict[str, int]:
    """Return a span; none is written as the longest that there is."""
    sec, nsec = divmod((span if span.nanoseconds else INFINITE).nanoseconds, NANOSECONDS)
    return {"sec": sec, "nsec": nsec}


def _dump(value: object) -> str:
    return yaml.dump(
        value, Dumper=_Dumper, sort_keys=False, default_flow_style=False, allow_unicode=True
    )


if TYPE_CHECKING:
    _BaseDumper = yaml.SafeDumper
else:
    _BaseDumper = getattr(yaml, "CSafeDumper", yaml.SafeDumper)


class _Dumper(_BaseDumper):
    """Writes every value in full: what stands twice is not written as a reference."""

    def ignore_aliases(self, data: object) -> bool:
        """Return that nothing is to be referred to."""
        del data
        return True

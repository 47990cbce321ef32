"""Which topics of a recording are played, and how each is offered: its QoS, its form, its name."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

from studio.bags.recording import KEPT_MAX, latched_count
from studio.errors import RosNameError, UnknownTypeError
from studio.nodes.recorded_topics import SERVICE_EVENTS, check_expressions
from studio.ros.node.publisher import RawPublisher
from studio.ros.profiles import NO_HASH
from studio.ros.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from studio.ros.tokens import EndpointKind
from studio.ros.types.files import InterfaceTexts

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from studio.bags.recording import RecordedTopic, Recording
    from studio.ros.client import Node
    from studio.ros.types.library import TypeLibrary

DEPTH: Final = 10
"""As rosbag2: how many samples were kept then says nothing of those who listen now."""
_OF_EVERY_NODE: Final = ("/rosout", "/parameter_events")


@dataclass(frozen=True, slots=True)
class Choice:
    """The topics that are wanted, by the options of `ros2 bag play`; without any, all."""

    topics: tuple[str, ...] = ()
    services: tuple[str, ...] = ()
    regex: str = ""
    exclude_regex: str = ""
    exclude_topics: tuple[str, ...] = ()
    exclude_services: tuple[str, ...] = ()

    def check(self) -> None:
        """Refuse what is no regular expression.

        Raises:
            SettingsError: One is none.
        """
        check_expressions({"--regex": self.regex, "--exclude-regex": self.exclude_regex})

    def takes(self, topic: str) -> bool:
        """Whether a topic is wanted."""
        service = topic.removesuffix(SERVICE_EVENTS) if topic.endswith(SERVICE_EVENTS) else None
        name, named, left_out = (
            (topic, self.topics, self.exclude_topics)
            if service is None
            else (service, self.services, self.exclude_services)
        )
        if self.topics or self.services or self.regex:
            is_named = name in full_names(named) or topic in full_names(self.topics)
            if not is_named and not (self.regex and re.search(self.regex, name)):
                return False
        if self.exclude_regex and re.search(self.exclude_regex, name):
            return False
        return name not in full_names(left_out)


def full_names(names: Iterable[str]) -> set[str]:
    """Return names with the first slash, which a line may leave out."""
    return {name if name.startswith("/") else f"/{name}" for name in names}


@dataclass(frozen=True, slots=True)
class Offer:
    """A topic that is played."""

    topic: RecordedTopic
    qos: QoSProfile
    publisher: RawPublisher
    kept: int
    """Messages of a latched one that say how things stood: as many as its publishers kept."""

    @property
    def is_latched(self) -> bool:
        """Whether late subscribers get what was played before."""
        return self.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL


def offered_qos(recorded: Sequence[QoSProfile]) -> QoSProfile | None:
    """Choose what to offer where so much was offered; None: they contradict each other.

    As rosbag2: if all agree in what decides who hears them, that, with the usual depth.
    """
    if not recorded:
        return QoSProfile(depth=DEPTH)
    first = recorded[0]
    if any(_decisive(one) != _decisive(first) for one in recorded):
        return None
    return replace(first, history=HistoryPolicy.KEEP_LAST, depth=DEPTH)


def _decisive(qos: QoSProfile) -> tuple[object, ...]:
    """Return the policies by which publishers and subscriptions match."""
    return (
        qos.reliability,
        qos.durability,
        qos.deadline,
        qos.liveliness,
        qos.liveliness_lease_duration,
    )


def learn_types(types: TypeLibrary, recording: Recording) -> None:
    """Let a node know, and describe to others, what only the recording defines."""
    texts = {
        name: text
        for name in recording.types.own_names()
        if not _is_known(types, name) and (text := recording.types.text_of(name)) is not None
    }
    types.add_sound_texts(InterfaceTexts(texts))


def _is_known(types: TypeLibrary, name: str) -> bool:
    try:
        types.interface(name)
    except UnknownTypeError:
        return False
    return True


def open_offers(
    node: Node,
    recording: Recording,
    topics: Iterable[RecordedTopic],
    overrides: Mapping[str, QoSProfile],
) -> dict[str, Offer]:
    """Publish topics by a node, which logs what cannot be, and what others may be surprised by."""
    offers: dict[str, Offer] = {}
    for topic in topics:
        try:
            offers[topic.name] = _opened(node, recording, topic, overrides)
        except (RosNameError, UnknownTypeError) as error:
            reason = str(error).rstrip(".")
            node.get_logger().warning(f"Ignoring a topic '{topic.name}', reason: {reason}.")
    return offers


def _opened(
    node: Node, recording: Recording, topic: RecordedTopic, overrides: Mapping[str, QoSProfile]
) -> Offer:
    """Publish a topic.

    Raises:
        RosNameError: A remapping makes another name of it, which is none.
        UnknownTypeError: The recording says neither what its type is nor which form it has.
    """
    if topic.trouble:
        raise UnknownTypeError(topic.type_name, topic.trouble.rstrip("."))
    recorded_hash = topic.type_hash if topic.type_hash != NO_HASH else ""
    type_hash = node.wire.profile.type_hash(
        recorded_hash or recording.types.hash_of(topic.type_name)
    )
    _tell_of_other_publishers(node, topic)
    _tell_of_other_form(node, topic, type_hash)
    qos = _qos_of(node, topic, overrides)
    kind = EndpointKind.PUBLISHER
    endpoint = node.endpoint(kind, topic.type_name, topic.name, qos, type_hash)
    publisher = RawPublisher(endpoint)
    node.on_destroy(publisher.destroy)
    kept = (qos.depth or DEPTH) if topic.name in overrides else latched_count(topic)
    return Offer(topic, qos, publisher, min(KEPT_MAX, kept))


def _qos_of(node: Node, topic: RecordedTopic, overrides: Mapping[str, QoSProfile]) -> QoSProfile:
    if (given := overrides.get(topic.name)) is not None:
        node.get_logger().info(f"Overriding QoS profile for topic {topic.name}")
        return given
    if not topic.qos and topic.is_latched:
        latched = DurabilityPolicy.TRANSIENT_LOCAL
        return QoSProfile(depth=latched_count(topic), durability=latched)
    if (found := offered_qos(topic.qos)) is not None:
        if found.durability is DurabilityPolicy.TRANSIENT_LOCAL:
            return replace(found, depth=max(found.depth, latched_count(topic)))
        return found
    node.get_logger().warning(
        f"Not all original publishers on topic {topic.name} offered the same QoS profiles. It is "
        "offered as topics are by default; --qos-profile-overrides-path offers it otherwise."
    )
    return QoSProfile(depth=DEPTH)


def _tell_of_other_publishers(node: Node, topic: RecordedTopic) -> None:
    name = node.resolve_topic_name(topic.name)
    if name in _OF_EVERY_NODE:
        return
    others = sorted({one.node.path for one in node.graph.publishers(name)})
    if others:
        node.get_logger().warning(
            f"{name} is published by {', '.join(others)} already: who listens hears both."
        )


def _tell_of_other_form(node: Node, topic: RecordedTopic, type_hash: str) -> None:
    types, profile = node.wire.types, node.wire.profile
    try:
        known = profile.type_hash(types.hash_of(topic.type_name))
    except UnknownTypeError:
        return
    if known != type_hash:
        node.get_logger().warning(
            f"{topic.name} was recorded in another form of {topic.type_name} than nodes of "
            f"{types.distro} have: they do not hear it."
        )

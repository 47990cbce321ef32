"""Which topics a recorder takes, and with which QoS, as `ros2 bag record` chooses."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from studio.errors import SettingsError
from studio.ros.names import is_hidden
from studio.ros.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

SERVICE_EVENTS: Final = "/_service_event"
"""The end of a topic's name on which services tell of their calls."""
DEPTH: Final = 10
DEPTH_MAX: Final = 1_000
"""Earlier samples that are asked for of a latched topic."""


def check_expressions(texts: Mapping[str, str]) -> None:
    """Pass if all are regular expressions, by the options that give them.

    Raises:
        SettingsError: One is none.
    """
    for option, text in texts.items():
        try:
            re.compile(text)
        except (re.error, OverflowError, RecursionError) as error:
            raise SettingsError(
                f"{option} {text[:80]}: {error}, so it is no regular expression."
            ) from None


@dataclass(frozen=True, slots=True)
class TopicChoice:
    """Which topics are wanted; one that is excluded is not, whatever else holds.

    Attributes:
        all: Every topic.
        services: Services whose events are wanted, by their full names; `all_services`: every one.
        topics: By their full names.
        types: By the types of their messages.
        regex: By an expression that is found in their names; empty: none.
        exclude_topics, exclude_services, exclude_types, exclude_regex: Those that are not wanted.
        hidden: Also those of which a part of the name begins with an underscore.
        unpublished: Also those that nobody publishes.
        ignore_leaves: Only those that somebody else subscribes to.
    """

    all: bool = False
    all_services: bool = False
    services: frozenset[str] = frozenset()
    topics: frozenset[str] = frozenset()
    types: frozenset[str] = frozenset()
    regex: str = ""
    exclude_topics: frozenset[str] = frozenset()
    exclude_services: frozenset[str] = frozenset()
    exclude_types: frozenset[str] = frozenset()
    exclude_regex: str = ""
    hidden: bool = False
    unpublished: bool = False
    ignore_leaves: bool = False

    def check(self) -> None:
        """Check the expressions.

        Raises:
            SettingsError: One is none.
        """
        check_expressions({"--regex": self.regex, "--exclude-regex": self.exclude_regex})

    def takes(self, name: str, type_name: str) -> bool:
        """Whether a topic is wanted, by its name and type."""
        if name.endswith(SERVICE_EVENTS):
            return self._takes_service(name.removesuffix(SERVICE_EVENTS), name)
        if is_hidden(name) and not self.hidden:
            return False
        if name in self.exclude_topics or type_name in self.exclude_types:
            return False
        if self.exclude_regex and re.search(self.exclude_regex, name):
            return False
        return (
            self.all
            or name in self.topics
            or type_name in self.types
            or bool(self.regex and re.search(self.regex, name))
        )

    def _takes_service(self, service: str, name: str) -> bool:
        if service in self.exclude_services:
            return False
        if self.exclude_regex and re.search(self.exclude_regex, name):
            return False
        return self.all_services or service in self.services or name in self.topics


@dataclass(frozen=True, slots=True)
class Adapted:
    """How a topic is subscribed, and why that is less than some of its publishers offer."""

    qos: QoSProfile
    warnings: tuple[str, ...] = field(default=())


def adapted(topic: str, offered: Sequence[QoSProfile]) -> Adapted:
    """Adapt to publishers as rosbag2 does: reliable and latched only where all of them are."""
    reliable = [one.reliability is not ReliabilityPolicy.BEST_EFFORT for one in offered]
    latched = [one.durability is DurabilityPolicy.TRANSIENT_LOCAL for one in offered]
    warnings = [
        f'Some, but not all, publishers on topic "{topic}" offer {what}. Falling back to '
        f"{instead} as it will connect to all."
        for found, what, instead in (
            (reliable, "reliable reliability", "best effort"),
            (latched, "transient local durability", "volatile"),
        )
        if any(found) and not all(found)
    ]
    depth = max((one.depth for one in offered), default=DEPTH)
    profile = QoSProfile(
        depth=min(max(depth, DEPTH), DEPTH_MAX),
        reliability=ReliabilityPolicy.RELIABLE if all(reliable) else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL
        if offered and all(latched)
        else DurabilityPolicy.VOLATILE,
    )
    return Adapted(profile, tuple(warnings))

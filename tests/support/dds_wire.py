# pyright: basic, reportMissingImports=false
# ruff: noqa: ANN401
"""DDS as ROS 2 uses it, for any type: names, QoS, user data and the graph; payloads are raw CDR.

A participant of Cyclone DDS that looks like one of rmw_cyclonedds_cpp. One process has one; what
it does is done by `turn`, in the thread that calls it.
"""

from __future__ import annotations

import os
from functools import cache
from typing import TYPE_CHECKING, Any, Final

from studio.ros.cdr import codec_of
from studio.ros.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from tests.support.dds_settings import loopback

os.environ.setdefault("CYCLONEDDS_URI", loopback())

from cyclonedds._clayer import ddspy_take, ddspy_write
from cyclonedds.core import (
    DDSException,
    GuardCondition,
    InstanceState,
    Policy,
    Qos,
    ReadCondition,
    SampleState,
    ViewState,
    WaitSet,
)
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import make_idl_struct
from cyclonedds.idl.types import uint8
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.ros.profiles import WireProfile
    from studio.ros.types.library import TypeLibrary

GRAPH_TYPE: Final = "rmw_dds_common/msg/ParticipantEntitiesInfo"
_GRAPH_TOPIC: Final = "ros_discovery_info"
_BLOCKS_NS: Final = 10**9
_TAKEN_AT_ONCE: Final = 64
_ALIGNED: Final = 4
_ANY: Final = SampleState.Any | ViewState.Any | InstanceState.Any


def dds_type(name: str) -> str:
    """`std_msgs/msg/String` as DDS names it: `std_msgs::msg::dds_::String_`."""
    package, kind, base = name.split("/")
    return f"{package}::{kind}::dds_::{base}_"


class DdsWriter:
    """Sends CDR on a topic."""

    def __init__(self, entity: Any) -> None:
        self._entity = entity
        self.guid: bytes = entity.guid.bytes

    def write(self, cdr: bytes | bytearray) -> None:
        """Send a message with its header of four bytes."""
        code = ddspy_write(self._entity._ref, bytes(cdr) + bytes(-len(cdr) % _ALIGNED))
        if code < 0:
            raise DDSException(code, "a message was not written")

    @property
    def matched(self) -> int:
        """How many readers it has."""
        return len(self._entity.get_matched_subscriptions())


class DdsReader:
    """Passes on the CDR that comes on a topic."""

    def __init__(self, entity: Any, hear: Callable[[bytes], None]) -> None:
        self._entity, self._hear = entity, hear
        self.guid: bytes = entity.guid.bytes
        self.condition = ReadCondition(entity, _ANY)

    @property
    def matched(self) -> int:
        """How many writers it has."""
        return len(self._entity.get_matched_publications())

    def take(self) -> None:
        """Pass on what has come."""
        while True:
            taken = ddspy_take(self._entity._ref, _ANY, _TAKEN_AT_ONCE)
            for cdr, info in taken:
                if info.valid_data:
                    self._hear(cdr)
            if len(taken) < _TAKEN_AT_ONCE:
                return


class DdsParticipant:
    """A participant, its ends, and the message that says which of them belong to which node."""

    def __init__(self, profile: WireProfile, types: TypeLibrary, domain: int) -> None:
        self.types, self._profile = types, profile
        self._entity = DomainParticipant(domain, qos=Qos(Policy.Userdata(b"enclave=/;")))
        self.guid: bytes = self._entity.guid.bytes
        self._readers: list[DdsReader] = []
        self._waitset, self._woken = WaitSet(self._entity), GuardCondition(self._entity)
        self._waitset.attach(self._woken)
        self._graph_kind = types.message(GRAPH_TYPE)
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._graph = self.writer(_GRAPH_TOPIC, GRAPH_TYPE, kept, self.hash_data(GRAPH_TYPE))

    def hash_data(self, type_name: str) -> str:
        """The user data of an end of this type; empty before Iron, which had no hashes."""
        if not self._profile.has_type_hash:
            return ""
        return f"typehash={self.types.hash_of(type_name)};"

    def writer(self, topic: str, type_name: str, qos: QoSProfile, user_data: str) -> DdsWriter:
        """An end that sends; `topic` is the name in DDS, `type_name` that of ROS."""
        made = Topic(self._entity, topic, _opaque(type_name))
        return DdsWriter(DataWriter(self._entity, made, qos=_qos(qos, user_data, writes=True)))

    def reader(
        self,
        topic: str,
        type_name: str,
        qos: QoSProfile,
        user_data: str,
        hear: Callable[[bytes], None],
    ) -> DdsReader:
        """An end that hears, until it is closed."""
        made = Topic(self._entity, topic, _opaque(type_name))
        entity = DataReader(self._entity, made, qos=_qos(qos, user_data, writes=False))
        reader = DdsReader(entity, hear)
        self._readers.append(reader)
        self._waitset.attach(reader.condition)
        return reader

    def close(self, end: DdsReader | DdsWriter) -> None:
        """Take an end away."""
        if isinstance(end, DdsReader):
            self._waitset.detach(end.condition)
            self._readers.remove(end)
            end.condition.__del__()
        end._entity.__del__()

    def write_graph(self, nodes: Iterable[tuple[str, str, list[bytes], list[bytes]]]) -> None:
        """Say which ends there are: namespace, name, guids of readers and of writers."""
        gid, entry = (
            self.types.message(f"rmw_dds_common/msg/{one}") for one in ("Gid", "NodeEntitiesInfo")
        )
        size = len(gid().data)  # 24 bytes in Humble, 16 since Iron

        def gids(guids: Iterable[bytes]) -> list[Any]:
            return [gid(data=guid.ljust(size, b"\0")) for guid in guids]

        entries = [
            entry(
                node_namespace=namespace,
                node_name=name,
                reader_gid_seq=gids(readers),
                writer_gid_seq=gids(writers),
            )
            for namespace, name, readers, writers in nodes
        ]
        told = self._graph_kind(gid=gids([self.guid])[0], node_entities_info_seq=entries)
        self._graph.write(codec_of(self._graph_kind).encode(told))

    def leave(self) -> None:
        """Tell the others that all is gone; who only ends is missed after ten seconds."""
        self._entity.__del__()

    def wake(self) -> None:
        """End a `turn` that waits; from any thread."""
        self._woken.set(True)

    def turn(self, timeout_s: float) -> None:
        """Wait for messages or for `wake`, and pass on what came."""
        self._waitset.wait(max(0, int(timeout_s * 1e9)))
        self._woken.set(False)
        for reader in tuple(self._readers):
            if reader in self._readers:
                reader.take()


@cache
def _opaque(type_name: str) -> Any:
    """A class for Cyclone with the right name: it never reads a message, so that any will do."""
    return make_idl_struct("Opaque", dds_type(type_name), {"octet": uint8})


def _qos(profile: QoSProfile, user_data: str, *, writes: bool) -> Any:
    keeps_all = profile.history is HistoryPolicy.KEEP_ALL
    history = Policy.History.KeepAll if keeps_all else Policy.History.KeepLast(profile.depth or 1)
    reliable = profile.reliability is not ReliabilityPolicy.BEST_EFFORT
    latched = profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
    policies: list[Any] = [
        Policy.Reliability.Reliable(_BLOCKS_NS) if reliable else Policy.Reliability.BestEffort,
        history,
        Policy.Durability.TransientLocal if latched else Policy.Durability.Volatile,
        Policy.DataRepresentation(use_cdrv0_representation=True),
    ]
    if latched and writes:
        policies.append(Policy.DurabilityService(0, history, -1, -1, -1))
    if user_data:
        policies.append(Policy.Userdata(user_data.encode()))
    return Qos(*policies)

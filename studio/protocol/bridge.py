"""Messages of the bridge: all that panels ask of, and hear from, a ROS 2 system."""

from __future__ import annotations

from typing import TypeAlias

from studio.protocol.deeds import DeedCommand, DeedEvent
from studio.protocol.diagnostics import DiagnosticsCommand, DiagnosticsEvent
from studio.protocol.driving import DriveCommand
from studio.protocol.graph import GraphCommand, GraphEvent
from studio.protocol.interfaces import InterfaceCommand, InterfaceEvent
from studio.protocol.lessons import LessonCommand, LessonEvent
from studio.protocol.lifecycle import LifecycleCommand, LifecycleEvent
from studio.protocol.logs import LogCommand, LogEvent
from studio.protocol.topic_rates import RatesCommand, RatesEvent
from studio.protocol.topics import TopicsCommand, TopicsEvent

BridgeCommand: TypeAlias = (
    InterfaceCommand
    | LogCommand
    | GraphCommand
    | LifecycleCommand
    | DiagnosticsCommand
    | RatesCommand
    | TopicsCommand
    | DeedCommand
    | DriveCommand
    | LessonCommand
)
"""Each concerns the connection, and none a document: the bridge desk carries them out."""
BridgeEvent: TypeAlias = (
    InterfaceEvent
    | LogEvent
    | GraphEvent
    | LifecycleEvent
    | DiagnosticsEvent
    | RatesEvent
    | TopicsEvent
    | DeedEvent
    | LessonEvent
)

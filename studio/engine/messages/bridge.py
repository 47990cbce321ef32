"""Messages of the bridge: all that panels ask of, and hear from, a ROS 2 system."""

from __future__ import annotations

from typing import TypeAlias

from studio.engine.messages.deeds import DeedCommand, DeedEvent
from studio.engine.messages.diagnostics import DiagnosticsCommand, DiagnosticsEvent
from studio.engine.messages.driving import DriveCommand
from studio.engine.messages.graph import GraphCommand, GraphEvent
from studio.engine.messages.interfaces import InterfaceCommand, InterfaceEvent
from studio.engine.messages.lessons import LessonCommand, LessonEvent
from studio.engine.messages.lifecycle import LifecycleCommand, LifecycleEvent
from studio.engine.messages.logs import LogCommand, LogEvent
from studio.engine.messages.topic_rates import RatesCommand, RatesEvent
from studio.engine.messages.topics import TopicsCommand, TopicsEvent

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

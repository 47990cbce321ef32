"""Messages of the bridge: all that panels ask of, and hear from, a ROS 2 system."""

from __future__ import annotations

from typing import TypeAlias

from studio.engine.messages.interfaces import InterfaceCommand, InterfaceEvent

BridgeCommand: TypeAlias = InterfaceCommand
"""Each concerns the connection, and none a document: the bridge desk carries them out."""
BridgeEvent: TypeAlias = InterfaceEvent

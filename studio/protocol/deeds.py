"""Messages about all that is done in a ROS 2 system from pages."""

from __future__ import annotations

from typing import TypeAlias

from studio.protocol.calls import CallCommand, CallEvent
from studio.protocol.goals import GoalCommand, GoalEvent
from studio.protocol.parameters import ParameterCommand, ParameterMessage
from studio.protocol.publishing import PublishCommand, PublishEvent

DeedCommand: TypeAlias = CallCommand | GoalCommand | PublishCommand | ParameterCommand
DeedEvent: TypeAlias = CallEvent | GoalEvent | PublishEvent | ParameterMessage

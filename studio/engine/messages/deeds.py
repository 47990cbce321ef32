"""Messages about all that is done in a ROS 2 system from pages."""

from __future__ import annotations

from typing import TypeAlias

from studio.engine.messages.calls import CallCommand, CallEvent
from studio.engine.messages.goals import GoalCommand, GoalEvent
from studio.engine.messages.parameters import ParameterCommand, ParameterMessage
from studio.engine.messages.publishing import PublishCommand, PublishEvent

DeedCommand: TypeAlias = CallCommand | GoalCommand | PublishCommand | ParameterCommand
DeedEvent: TypeAlias = CallEvent | GoalEvent | PublishEvent | ParameterMessage

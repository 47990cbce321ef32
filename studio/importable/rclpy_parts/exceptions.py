"""Exceptions of rclpy: those without a counterpart in the studio's tree, and names of the others.

A user sees `rclpy.exceptions.ParameterNotDeclaredException` in a traceback, as with rclpy.
"""

from __future__ import annotations

from studio import errors
from studio.errors import (
    DestroyedError,
    ExecutorTimeoutError,
    NamespaceError,
    NodeNameError,
    NodeNameNonExistentError,
    NotJoinedError,
    RosNameError,
    TopicNameError,
)

NameValidationException = RosNameError
InvalidTopicNameException = TopicNameError
InvalidServiceNameException = TopicNameError
InvalidNodeNameException = NodeNameError
InvalidNamespaceException = NamespaceError
NotInitializedException = NotJoinedError
InvalidHandle = DestroyedError
TimeoutException = ExecutorTimeoutError


__all__ = [
    "ConditionReachedException", "InvalidHandle", "InvalidNamespaceException",
    "InvalidNodeNameException", "InvalidParameterException", "InvalidServiceNameException",
    "InvalidTopicNameException", "NameValidationException", "NoTypeSupportImportedException",
    "NodeNameNonExistentError", "NotInitializedException", "ROSInterruptException",
    "ShutdownException", "TimeoutException", "TimerCancelledError", "name_as_rclpy",
]  # fmt: skip


class ROSInterruptException(Exception):  # noqa: N818
    """Raised by `Rate.sleep` when the process is asked to end."""


class NoTypeSupportImportedException(Exception):  # noqa: N818
    """A class is no class of messages."""


class InvalidParameterException(RosNameError):  # noqa: N818
    """A parameter cannot be named so."""


class TimerCancelledError(Exception):
    """A timer was cancelled, and is asked when it is due."""


class ShutdownException(Exception):  # noqa: N818
    """An executor was shut down."""


class ConditionReachedException(Exception):  # noqa: N818
    """What was waited for is so."""


_NAMES = {
    "rclpy.exceptions": {
        "ParameterError": "ParameterException",
        "ParameterNotDeclaredError": "ParameterNotDeclaredException",
        "ParameterAlreadyDeclaredError": "ParameterAlreadyDeclaredException",
        "ParameterImmutableError": "ParameterImmutableException",
        "ParameterUninitializedError": "ParameterUninitializedException",
        "InvalidParameterTypeError": "InvalidParameterTypeException",
        "InvalidParameterValueError": "InvalidParameterValueException",
        "RosNameError": "NameValidationException",
        "TopicNameError": "InvalidTopicNameException",
        "NodeNameError": "InvalidNodeNameException",
        "NamespaceError": "InvalidNamespaceException",
        "NotJoinedError": "NotInitializedException",
    },
    "rclpy.executors": {"ExternalShutdownException": "ExternalShutdownException"},
    "rclpy._rclpy_pybind11": {
        "RclError": "RCLError",
        "RosArgumentError": "UnknownROSArgsError",
        "DestroyedError": "InvalidHandle",
        "NodeNameNonExistentError": "NodeNameNonExistentError",
        "UnsupportedEventTypeError": "UnsupportedEventTypeError",
    },
    "rclpy.qos_overriding_options": {"QosOverrideError": "InvalidQosOverridesError"},
    "builtins": {
        "AlreadyJoinedError": "RuntimeError",
        "OtherMessageError": "TypeError",
        "MessageValueError": "AssertionError",
    },
}


def name_as_rclpy() -> None:
    """Give the studio's errors the names that users of rclpy know; for this whole process."""
    for module, names in _NAMES.items():
        for ours, theirs in names.items():
            kind: type[Exception] = getattr(errors, ours)
            kind.__module__, kind.__name__, kind.__qualname__ = module, theirs, theirs
    for kind in (ROSInterruptException, NoTypeSupportImportedException, InvalidParameterException,
                 TimerCancelledError):  # fmt: skip
        kind.__module__ = "rclpy.exceptions"

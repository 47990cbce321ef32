"""Errors by the names that rclpy's users catch: `from studio.ros.exceptions import ...`."""

from __future__ import annotations

from studio.errors import (
    InvalidParameterTypeError,
    InvalidParameterValueError,
    ParameterAlreadyDeclaredError,
    ParameterError,
    ParameterImmutableError,
    ParameterNotDeclaredError,
    ParameterUninitializedError,
)

ParameterException = ParameterError
ParameterAlreadyDeclaredException = ParameterAlreadyDeclaredError
ParameterNotDeclaredException = ParameterNotDeclaredError
ParameterImmutableException = ParameterImmutableError
ParameterUninitializedException = ParameterUninitializedError
InvalidParameterTypeException = InvalidParameterTypeError
InvalidParameterValueException = InvalidParameterValueError

"""ParameterStore: the parameters of a node with their types, ranges, values and callbacks."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from studio.errors import (
    InvalidParameterTypeError,
    InvalidParameterValueError,
    ParameterAlreadyDeclaredError,
    ParameterError,
    ParameterImmutableError,
    ParameterNotDeclaredError,
    ParameterUninitializedError,
)
from studio.ros.parameters.parameter import (
    Parameter,
    ParameterMessages,
    ParameterType,
    usual_messages,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.ros.types.classes import MessageValue

PreSetCallback = Callable[[list["Parameter"]], list["Parameter"]]
OnSetCallback = Callable[[list["Parameter"]], Any]
"""Returns a SetParametersResult, or anything with `successful` and `reason`."""
PostSetCallback = Callable[[list["Parameter"]], None]
_TOLERANCE = 1e-9
NAME_CHARACTERS_MAX = 1_000
_DESCRIPTOR_FIELDS = (
    "description",
    "additional_constraints",
    "read_only",
    "dynamic_typing",
    "floating_point_range",
    "integer_range",
)


class ParameterCallbacks:
    """The callbacks of a node; those added last are called first, as in rclpy."""

    def __init__(self) -> None:
        self.pre_set: list[PreSetCallback] = []
        self.on_set: list[OnSetCallback] = []
        self.post_set: list[PostSetCallback] = []

    def before(self, parameters: list[Parameter]) -> list[Parameter]:
        """Let callbacks change what is to be set."""
        for callback in self.pre_set:
            parameters = list(callback(parameters))
        return parameters

    def ask(self, parameters: list[Parameter], agreed: MessageValue) -> Any:  # noqa: ANN401
        """Return the first refusal, else `agreed`."""
        for callback in self.on_set:
            result = callback(parameters)
            if not getattr(result, "successful", False):
                return _refusal(result, agreed)
        return agreed

    def after(self, parameters: Iterable[Parameter]) -> None:
        """Call back after parameters were set."""
        for callback in self.post_set:
            callback(list(parameters))


def _refusal(result: Any, agreed: MessageValue) -> MessageValue:  # noqa: ANN401
    # A callback without a return statement refuses everything: report it, it is a usual slip.
    reason = getattr(result, "reason", "the callback of the node returned no SetParametersResult")
    return type(agreed)(successful=False, reason=reason or "the callback of the node refused it")


def range_violation(parameter: Parameter, descriptor: MessageValue) -> str | None:
    """Return rclpy's message for a value outside a descriptor's range; None if it is inside.

    The ends of a range are always accepted; a step counts from its lower end, 0 is none.
    """
    if parameter.type_ is ParameterType.INTEGER and descriptor.integer_range:
        return _integer_violation(parameter, descriptor.integer_range[0])
    if parameter.type_ is ParameterType.DOUBLE and descriptor.floating_point_range:
        return _double_violation(parameter, descriptor.floating_point_range[0])
    return None


def _integer_violation(parameter: Parameter, span: MessageValue) -> str | None:
    value, low, high = parameter.value, *_ends(span)
    if value in (low, high):
        return None
    if not low < value < high:
        return f"Parameter {parameter.name} out of range. Min: {low}, Max: {high}, value: {value}"
    if span.step and (value - low) % span.step:
        return (
            f"The parameter value for {parameter.name} is not a valid step. "
            f"Min: {low}, max: {high}, value: {value}, step: {span.step}"
        )
    return None


def _double_violation(parameter: Parameter, span: MessageValue) -> str | None:
    value, low, high = parameter.value, *_ends(span)
    if _close(value, low) or _close(value, high):
        return None
    if not low < value < high:
        # rclpy has a full stop after "range" for integers alone.
        return f"Parameter {parameter.name} out of range Min: {low}, Max: {high}, value: {value}"
    steps = (value - low) / span.step if span.step > 0 else math.inf
    if math.isfinite(steps) and not _close(value, low + round(steps) * span.step):
        return (
            f"The parameter value for {parameter.name} is not close enough to a valid step. "
            f"Min: {low}, max: {high}, value: {value}, step: {span.step}"
        )
    return None


def _ends(span: MessageValue) -> tuple[Any, Any]:
    """Return the lower end and the upper one, which a descriptor may have in either order."""
    low, high = span.from_value, span.to_value
    return (high, low) if high < low else (low, high)


def _close(one: float, other: float) -> bool:
    return math.isclose(one, other, rel_tol=_TOLERANCE, abs_tol=_TOLERANCE)


@dataclass(frozen=True, slots=True)
class ParameterChange:
    """What one step changed, as in `/parameter_events`."""

    new: tuple[Parameter, ...] = ()
    changed: tuple[Parameter, ...] = ()
    deleted: tuple[Parameter, ...] = ()


@dataclass(slots=True)
class _Declared:
    """A parameter and its descriptor; the descriptor's type is the one it keeps."""

    parameter: Parameter
    descriptor: MessageValue


@dataclass(slots=True)
class _Step:
    """Parameters about to be set, sorted by what they will be."""

    new: list[Parameter] = field(default_factory=list[Parameter])
    changed: list[Parameter] = field(default_factory=list[Parameter])
    deleted: list[Parameter] = field(default_factory=list[Parameter])


class ParameterStore:
    """The parameters of one node; thread-safe.

    Attributes:
        overrides: Values given at the start, which come before those in the code.
        callbacks: What is called before and after changes.
    """

    def __init__(
        self,
        publish: Callable[[ParameterChange], None],
        *,
        messages: ParameterMessages | None = None,
        overrides: Mapping[str, Parameter] | None = None,
        allow_undeclared: bool = False,
    ) -> None:
        self.messages = messages or usual_messages()
        self.overrides = dict(overrides or {})
        self.callbacks = ParameterCallbacks()
        self._publish = publish
        self._allow_undeclared = allow_undeclared
        self._declared: dict[str, _Declared] = {}
        # Of changes: a callback may set others, so its own thread is let in again. Reading takes
        # no lock, so that a callback may wait for another thread that reads.
        self._lock = threading.RLock()

    def declare(
        self,
        name: str,
        value: Any = None,  # noqa: ANN401  # a value, a type or a Parameter
        descriptor: MessageValue | None = None,
        *,
        ignore_override: bool = False,
    ) -> Parameter:
        """Declare a parameter by a value, or by its type alone as `Parameter.Type.STRING`.

        Raises:
            ParameterAlreadyDeclaredError: There is one of that name.
            InvalidParameterTypeError: An override is of another type.
            InvalidParameterValueError: The value is refused.
        """
        with self._lock:
            if name in self._declared:
                raise ParameterAlreadyDeclaredError(name)
            _check_name(name)
            own = self._descriptor(name, value, descriptor)
            default = _default(name, value)
            given = default if ignore_override else self.overrides.get(name, default)
            self._check(given, own)
            result = self.callbacks.ask([given], self.messages.SetParametersResult(successful=True))
            if not result.successful:
                raise InvalidParameterValueError(name, result.reason)
            self._declared[name] = _Declared(given, own)
        self._publish(ParameterChange(new=(given,)))
        self.callbacks.after([given])
        return given

    def undeclare(self, name: str) -> None:
        """Take a parameter away.

        Raises:
            ParameterNotDeclaredError: There is none of that name.
            ParameterImmutableError: It may only be read.
        """
        with self._lock:
            known = self._find(name)
            if known.descriptor.read_only:
                raise ParameterImmutableError(name)
            del self._declared[name]
        self._publish(ParameterChange(deleted=(Parameter(name),)))

    def has(self, name: str) -> bool:
        """Whether there is a parameter of that name."""
        return name in self._declared

    def get(self, name: str) -> Parameter:
        """Return a parameter.

        Raises:
            ParameterNotDeclaredError: There is none of that name.
            ParameterUninitializedError: It was declared by its type and never set.
        """
        if self._allow_undeclared and name not in self._declared:
            return Parameter(name)
        known = self._find(name)
        parameter = known.parameter
        if parameter.type_ is ParameterType.NOT_SET and not known.descriptor.dynamic_typing:
            raise ParameterUninitializedError(name)
        return parameter

    def all(self) -> dict[str, Parameter]:
        """Return every parameter in the order of the alphabet."""
        declared = dict(self._declared)
        return {name: declared[name].parameter for name in sorted(declared)}

    def describe(self, name: str) -> MessageValue:
        """Return the descriptor of a parameter.

        Raises:
            ParameterNotDeclaredError: There is none of that name.
        """
        if self._allow_undeclared and name not in self._declared:
            return self.messages.ParameterDescriptor(name=name)
        return self._find(name).descriptor

    def redescribe(
        self,
        name: str,
        descriptor: MessageValue,
        value: Any = None,  # noqa: ANN401  # a value or None
    ) -> Any:  # noqa: ANN401  # the value that it has now
        """Return a parameter another descriptor, and another value where the old one does not fit.

        Raises:
            ParameterNotDeclaredError: There is none of that name.
            ParameterImmutableError: It may only be read.
            InvalidParameterTypeError: The value is of another type.
            InvalidParameterValueError: The value is outside the new range.
        """
        with self._lock:
            known = self._find(name)
            if known.descriptor.read_only:
                raise ParameterImmutableError(name)
            parameter = known.parameter if value is None else _default(name, value)
            own = self._descriptor(name, known.parameter.value, descriptor)
            self._check(parameter, own)
            known.descriptor, known.parameter = own, parameter
        if value is not None:
            self._publish(ParameterChange(changed=(parameter,)))
        return parameter.value

    def set(self, parameters: Iterable[Parameter]) -> list[MessageValue]:
        """Set parameters one after another; a refused one hinders no other.

        Raises:
            ParameterNotDeclaredError: One is not declared; those before it are set.
        """
        return [self.set_atomically([parameter]) for parameter in parameters]

    def set_atomically(self, parameters: Iterable[Parameter]) -> MessageValue:
        """Set all or none, and return one SetParametersResult.

        Raises:
            ParameterNotDeclaredError: One is not declared; none is set.
        """
        result, wanted = self.settle(parameters)
        if result.successful:
            self.callbacks.after(wanted)
        return result

    def settle(self, parameters: Iterable[Parameter]) -> tuple[MessageValue, list[Parameter]]:
        """Set all or none, and return the result and what was wanted in the end.

        The caller calls the callbacks that follow a change.

        Raises:
            ParameterNotDeclaredError: One is not declared; none is set.
        """
        with self._lock:
            wanted = self.callbacks.before(list(parameters))
            step = self._sorted(wanted)
            result = self._judge(wanted)
            if not result.successful:
                return result, wanted
            self._apply(step)
        self._publish(ParameterChange(tuple(step.new), tuple(step.changed), tuple(step.deleted)))
        return result, wanted

    def _descriptor(self, name: str, value: object, given: MessageValue | None) -> MessageValue:
        """Complete a descriptor of our own: its name, and the type that the parameter keeps."""
        made = self.messages.ParameterDescriptor(name=name)
        if given is None:
            made.dynamic_typing = value is None
        else:
            for attribute in _DESCRIPTOR_FIELDS:
                setattr(made, attribute, getattr(given, attribute))
        if not made.dynamic_typing:
            kind = value if isinstance(value, ParameterType) else _default(name, value).type_
            if kind is ParameterType.NOT_SET:
                raise InvalidParameterTypeError(
                    name, "give a value, a type, or a descriptor with dynamic_typing=True"
                )
            made.type = int(kind)
        return made

    def _find(self, name: str) -> _Declared:
        known = self._declared.get(name)
        if known is None:
            raise ParameterNotDeclaredError(name)
        return known

    def _sorted(self, wanted: list[Parameter]) -> _Step:
        step = _Step()
        for parameter in wanted:
            known = self._declared.get(parameter.name)
            if known is None and not self._allow_undeclared:
                raise ParameterNotDeclaredError(parameter.name)
            deletes = parameter.type_ is ParameterType.NOT_SET
            if deletes and known is not None:
                if parameter not in step.deleted:  # a request may name one twice
                    step.deleted.append(parameter)
            elif not deletes:
                was_set = known and known.parameter.type_ is not ParameterType.NOT_SET
                (step.changed if was_set else step.new).append(parameter)
        return step

    def _judge(self, wanted: list[Parameter]) -> Any:  # noqa: ANN401  # a SetParametersResult
        agreed = self.messages.SetParametersResult(successful=True)
        try:
            for parameter in wanted:
                known = self._declared.get(parameter.name)
                if known is not None:
                    self._check_change(parameter, known.descriptor)
        except InvalidParameterValueError as error:
            # rclpy's message, by which others may recognise it.
            return self.messages.SetParametersResult(successful=False, reason=error.reason)
        except ParameterError as error:
            return self.messages.SetParametersResult(successful=False, reason=str(error))
        return self.callbacks.ask(wanted, agreed)

    def _check_change(self, parameter: Parameter, descriptor: MessageValue) -> None:
        if descriptor.read_only:
            raise ParameterImmutableError(parameter.name)
        deletes = parameter.type_ is ParameterType.NOT_SET
        if deletes and not descriptor.dynamic_typing:
            raise InvalidParameterTypeError(
                parameter.name, f"it keeps the type {_label(descriptor)} and cannot be taken away"
            )
        self._check(parameter, descriptor)

    def _check(self, parameter: Parameter, descriptor: MessageValue) -> None:
        kind = parameter.type_
        unset = kind is ParameterType.NOT_SET
        if not (descriptor.dynamic_typing or unset) and kind != descriptor.type:
            raise InvalidParameterTypeError(
                parameter.name, f"it is {_label(descriptor)}, {kind.label} was given"
            )
        reason = range_violation(parameter, descriptor)
        if reason is not None:
            raise InvalidParameterValueError(parameter.name, reason)

    def _apply(self, step: _Step) -> None:
        for parameter in (*step.new, *step.changed):
            known = self._declared.get(parameter.name)
            if known is None:
                descriptor = self.messages.ParameterDescriptor(
                    name=parameter.name, dynamic_typing=True
                )
                known = self._declared[parameter.name] = _Declared(parameter, descriptor)
            known.parameter = parameter
            if known.descriptor.dynamic_typing:
                known.descriptor.type = int(parameter.type_)
        for parameter in step.deleted:
            del self._declared[parameter.name]


def _default(name: str, value: object) -> Parameter:
    if isinstance(value, ParameterType):
        return Parameter(name)
    if isinstance(value, Parameter):
        return Parameter(name, value.type_, value.value)
    return Parameter(name, value=value)


def _label(descriptor: MessageValue) -> str:
    return ParameterType(descriptor.type).label


def _check_name(name: str) -> None:
    if not name or len(name) > NAME_CHARACTERS_MAX:
        raise InvalidParameterValueError(
            name, f"a parameter has a name of 1 to {NAME_CHARACTERS_MAX} characters."
        )

"""Errors of what nodes ask of each other: parameters, actions, managed nodes, descriptions."""

from __future__ import annotations

from studio.errors.wire import WireError


class ParameterError(WireError):
    """A parameter cannot be declared, read or set."""


class ParameterNotDeclaredError(ParameterError):
    """A node has no parameter of that name."""

    def __init__(self, name: str) -> None:
        super().__init__(f'The parameter "{name[:200]}" is not declared: declare it first.')
        self.name = name


class ParameterAlreadyDeclaredError(ParameterError):
    """A node has a parameter of that name already."""

    def __init__(self, name: str) -> None:
        super().__init__(
            f'The parameter "{name[:200]}" is declared already: declare it once, then read or set '
            "it (every node declares use_sim_time by itself)."
        )
        self.name = name


class ParameterImmutableError(ParameterError):
    """A parameter that may only be read was to be changed or taken away."""

    def __init__(self, name: str) -> None:
        super().__init__(
            f'The parameter "{name[:200]}" is read-only: give its value when the node is started.'
        )
        self.name = name


class ParameterUninitializedError(ParameterError):
    """A parameter was declared by its type alone, and nobody gave it a value yet."""

    def __init__(self, name: str) -> None:
        super().__init__(
            f'The parameter "{name[:200]}" has no value yet: give it one when the node is started, '
            "or set it."
        )
        self.name = name


class InvalidParameterTypeError(ParameterError):
    """A parameter was given a value of another type than its own, or of none that ROS 2 has."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(f'The parameter "{name[:200]}" does not take that type: {reason}.')
        self.name, self.reason = name, reason


class InvalidParameterValueError(ParameterError):
    """A parameter was given a value outside its range, or one that its node refuses."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(f'The parameter "{name[:200]}" was refused: {reason}')
        self.name, self.reason = name, reason


class ParameterFileError(ParameterError):
    """A file of parameters cannot be read."""

    def __init__(self, where: str, reason: str) -> None:
        super().__init__(f"{where}: {reason}.")
        self.where, self.reason = where, reason


class CallError(WireError):
    """A node was asked and gave no answer."""


class NotServedError(CallError):
    """No node serves what was asked for, or none does any more."""

    def __init__(self, what: str, name: str) -> None:
        super().__init__(f"No node serves the {what} {name}: start its node, or look at its name.")
        self.what, self.name = what, name


class ServedOtherwiseError(CallError):
    """Somebody serves what was asked for, with another type or another form of it."""

    def __init__(self, what: str, name: str, asked: str, types: tuple[str, ...]) -> None:
        served = " and ".join(types)
        how = (
            f"with another form of {asked}: give the studio the text that its node has"
            if asked in types
            else f"as {served}, not as {asked}: call it with that type"
        )
        super().__init__(f"The {what} {name} is served {how}.")
        self.what, self.name, self.asked, self.types = what, name, asked, types


class NoAnswerError(CallError):
    """A server is there and was silent for too long."""

    def __init__(self, what: str, name: str, timeout_s: float) -> None:
        super().__init__(
            f"The {what} {name} gave no answer within {timeout_s:g} s: "
            "its node may be busy, or hang; give it more time, or start it again."
        )
        self.what, self.name, self.timeout_s = what, name, timeout_s


class DroppedError(CallError):
    """A server is there and let a request fall, as servers do when too many come at once."""

    def __init__(self, what: str, name: str) -> None:
        super().__init__(
            f"The {what} {name} dropped a request: too many came at once, or its node just ended; "
            "ask again, fewer at a time."
        )
        self.what, self.name = what, name


class ServiceServerGoneError(CallError):
    """The server of a service ended while a call of ours was under way."""

    def __init__(self, name: str) -> None:
        super().__init__(
            f"The node that served the service {name} ended before it answered: "
            "start it and call again."
        )
        self.name = name


class ActionServerGoneError(CallError):
    """The server of an action ended while a goal of ours was under way."""

    def __init__(self, name: str) -> None:
        super().__init__(
            f"The node that served the action {name} ended before the goal did: "
            "start it and send the goal again."
        )
        self.name = name


class GoalStateError(WireError):
    """A goal was to change to a state that does not follow the one it is in."""

    def __init__(self, status: str, event: str) -> None:
        super().__init__(f"A goal that is {status} cannot {event}: do it once, in its order.")
        self.status, self.event = status, event


class TransitionError(WireError):
    """A managed node was to take a transition that does not begin in its state."""

    def __init__(self, transition: str, state: str, known: list[str]) -> None:
        others = ", ".join(known) or "none"
        super().__init__(
            f'A node that is {state} takes no transition "{transition[:80]}": it takes {others}.'
        )
        self.transition, self.state = transition, state


class TypeDescriptionError(WireError):
    """A node described a type in a way that cannot be trusted or used."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(f'The description of "{name[:200]}" was not taken: {reason}.')
        self.name, self.reason = name, reason

"""Errors of what comes from ROS 2 and goes to it."""

from __future__ import annotations

from studio.errors.root import StudioError


class WireError(StudioError):
    """What came from ROS, or should go to it, is not as ROS 2 wants it."""


class WireSettingsError(WireError):
    """What the options or the environment say of the wire cannot be; the text says what to set."""


class NoRouterError(WireError):
    """No Zenoh router answers where one was looked for."""

    def __init__(self, endpoints: tuple[str, ...], reason: str) -> None:
        self.endpoints = endpoints
        self.reason = reason
        places = ", ".join(endpoints) or "the configured address"
        super().__init__(
            f"No Zenoh router answers at {places}: start one there (studio router, or "
            "ros2 run rmw_zenoh_cpp rmw_zenohd), or name another with --connect."
        )


class RouterGoneError(WireError):
    """The router that was joined is away, so that nothing goes out and nothing comes."""

    def __init__(self, endpoint: str) -> None:
        super().__init__(
            f"The router at {endpoint} is gone, so nobody can be asked or told anything: start it "
            "there again (studio router), then try once more."
        )
        self.endpoint = endpoint


class ForeignEndpointError(WireError):
    """The endpoint of a router is held by a program that does not speak Zenoh."""

    def __init__(self, endpoint: str) -> None:
        super().__init__(
            f"Something that is no Zenoh router holds {endpoint}: end it, or name another place "
            "with --router or --connect."
        )
        self.endpoint = endpoint


class NotAdmittedError(WireError):
    """A router answers, and hangs up when a session is opened."""

    def __init__(self, endpoint: str) -> None:
        super().__init__(
            f"The router at {endpoint} lets nobody in without the name, password or certificate "
            "that it knows: set them in ZENOH_CONFIG_OVERRIDE or ZENOH_SESSION_CONFIG_URI."
        )
        self.endpoint = endpoint


class RouterNotStartedError(WireError):
    """A router cannot listen where it should; `held` says that another program does."""

    def __init__(self, endpoint: str, reason: str, *, held: bool) -> None:
        why = "another program listens there" if held else reason.rstrip(".! ")
        super().__init__(
            f"No router was started at {endpoint} ({why}): name another place with --listen "
            "or --router."
        )
        self.endpoint, self.reason, self.held = endpoint, reason, held


class RosNameError(WireError):
    """A name, namespace, type name or key breaks a rule of ROS 2."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(f'"{name[:200]}" cannot be used in ROS 2: {reason}.')
        self.name, self.reason = name, reason


class TokenError(WireError):
    """A liveliness token, or the QoS in it, is none of rmw_zenoh's."""

    def __init__(self, token: str, reason: str) -> None:
        super().__init__(f"The liveliness token {token[:200]} was not understood: {reason}.")
        self.token, self.reason = token, reason


class AttachmentError(WireError):
    """A sample or call came without the number, time and sender that rmw_zenoh attaches."""

    def __init__(self, reason: str) -> None:
        super().__init__(f"Its attachment cannot be read: {reason}.")
        self.reason = reason


class InterfaceError(WireError):
    """A message, service or action type cannot be used."""


class InterfaceTextError(InterfaceError):
    """A .msg, .srv or .action text breaks a rule; `line` is 1-based, None for the text whole."""

    def __init__(self, name: str, line: int | None, reason: str) -> None:
        super().__init__(f"{name if line is None else f'{name}:{line}'}: {reason}.")
        self.name, self.line, self.reason = name, line, reason

    def at(self, path: str) -> InterfaceTextError:
        """Give the same error of the file that the text stands in."""
        return InterfaceTextError(path, self.line, self.reason)


class UnknownTypeError(InterfaceError):
    """No type of that name is known, or one that it is made of is not."""

    def __init__(self, name: str, reason: str | None = None) -> None:
        why = reason or "no known package defines it: open its package or give --interfaces"
        super().__init__(f'The type "{name[:200]}" cannot be used: {why}.')
        self.name, self.reason = name, reason


class MessageValueError(WireError):
    """A value does not fit the field of a message."""

    def __init__(self, field: str, reason: str) -> None:
        super().__init__(f"{field}: {reason}.")
        self.field, self.reason = field, reason


class CdrError(WireError):
    """Bytes from the wire are no message of the type."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(f"The bytes are no {name}: {reason}.")
        self.name, self.reason = name, reason

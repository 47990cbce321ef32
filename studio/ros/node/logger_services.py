"""The services by which others see and set from which level on the loggers of a process write."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.ros.node.logger import LoggingSeverity, get_logger, own_level, own_levels

if TYPE_CHECKING:
    from studio.ros.hosting import Host
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import TypeLibrary

LEVELS_MAX = 1_000
"""Loggers with a level of their own: peers may invent names."""
NAME_CHARACTERS_MAX = 255


class LoggerServices:
    """`get_logger_levels` and `set_logger_levels` of a node."""

    def __init__(self, host: Host, types: TypeLibrary) -> None:
        self._level = types.message("rcl_interfaces/msg/LoggerLevel")
        self._result = types.message("rcl_interfaces/msg/SetLoggerLevelsResult")
        name = host.get_fully_qualified_name()
        for kind, callback in (("get", self._get), ("set", self._set)):
            service = types.service(f"rcl_interfaces/srv/{kind.title()}LoggerLevels")
            host.create_service(service, f"{name}/{kind}_logger_levels", callback)

    def _get(self, request: MessageValue, response: MessageValue) -> MessageValue:
        response.levels = [
            self._level(name=name, level=int(own_level(name))) for name in request.names
        ]
        return response

    def _set(self, request: MessageValue, response: MessageValue) -> MessageValue:
        response.results = [self._set_one(one) for one in request.levels]
        return response

    def _set_one(self, wanted: MessageValue) -> MessageValue:
        refusal = _refusal(wanted.name, int(wanted.level))
        if refusal is not None:
            return self._result(successful=False, reason=refusal)
        get_logger(wanted.name).set_level(int(wanted.level))
        return self._result(successful=True)


def _refusal(name: str, level: int) -> str | None:
    if level not in set(LoggingSeverity):
        return f"{level} is no level: give 0, 10, 20, 30, 40 or 50."
    if len(name) > NAME_CHARACTERS_MAX:
        return f"A logger has a name of at most {NAME_CHARACTERS_MAX} characters."
    if name not in own_levels() and len(own_levels()) >= LEVELS_MAX:
        return f"{LEVELS_MAX} loggers have a level of their own already."
    return None

"""A service's callback that returned nothing: the mistake, where the traceback shows our code."""

from __future__ import annotations

import traceback
from typing import Any

from studio.importable.hints.said import place_of
from studio.ros.node.service import Service


def answer_hint(error: BaseException) -> str | None:
    """Return a sentence about a service's callback without `return`; None: it is something else.

    Args:
        error: What ended the program.
    """
    if "NoneType" not in str(error):
        return None
    for frame, _ in traceback.walk_tb(error.__traceback__):
        service: Any = frame.f_locals.get("self")
        if isinstance(service, Service) and frame.f_locals.get("given", error) is None:
            called: Any = service.callback
            code: Any = getattr(called, "__code__", None)
            at = f" ({place_of(code.co_filename, code.co_firstlineno)})" if code else ""
            name = getattr(called, "__name__", "callback")
            return (
                f"The callback {name}{at} of the service {service.endpoint.token.name} returned "
                "None, and its caller waits for an answer: end it with return response."
            )
    return None

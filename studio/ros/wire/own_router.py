"""A router of our own, where none answers: for sessions, and for those who open none."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

from studio.errors import ForeignEndpointError, NoRouterError, RouterNotStartedError
from studio.ros.wire.endpoints import Endpoint, ProbeResult, parse_endpoint, probe
from studio.ros.wire.router import EmbeddedRouter, RouterChoice, router_choice, start_router
from studio.ros.wire.zenoh import use_few_threads

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.wire.settings import WireSettings


@contextmanager
def held_router(settings: WireSettings, router: str = "auto") -> Generator[WireSettings]:
    """Have a router for as long as the block lasts, without a session; gives how it is joined.

    It costs a third of a session: for who starts nodes in other processes.

    Args:
        settings: Where the router is.
        router: As `open_wire` takes it.

    Raises:
        NoRouterError: None answers, and none may be started.
        ForeignEndpointError: Something that is no Zenoh holds the endpoint.
        RouterNotStartedError: None answers, and the endpoint cannot be listened at.
    """
    use_few_threads()
    choice = router_choice(router)
    if choice.endpoint is not None:
        settings = replace(settings, connect=(choice.endpoint.text,))
    own: EmbeddedRouter | None = None
    if answer_at(settings) is ProbeResult.NOBODY:
        if place_for_router(settings, choice) is None:
            raise NoRouterError(settings.connect, "nobody answers")
        own = router_of_our_own(settings, choice)
    try:
        yield settings
    finally:
        if own is not None:
            own.close()


def router_of_our_own(settings: WireSettings, choice: RouterChoice) -> EmbeddedRouter | None:
    """Start a router if none answers; None if none is wanted.

    Raises:
        RouterNotStartedError: The endpoint cannot be listened at.
    """
    place = place_for_router(settings, choice)
    if place is None:
        return None
    try:
        return start_router(place, settings.overrides, settings.router_config_file)
    except RouterNotStartedError as error:
        if error.held:
            return None  # another process was quicker: it is joined
        raise


def answer_at(settings: WireSettings) -> ProbeResult:
    """Probe the only endpoint; of several, Zenoh takes any that answers.

    Raises:
        ForeignEndpointError: Something that is no Zenoh holds it.
    """
    if len(settings.connect) != 1:
        return ProbeResult.UNKNOWN
    found = probe(parse_endpoint(settings.connect[0]))
    if found is ProbeResult.OTHER:
        raise ForeignEndpointError(settings.connect[0])
    return found


def place_for_router(settings: WireSettings, choice: RouterChoice) -> Endpoint | None:
    """Return where a router is started if none answers; None: nowhere."""
    if not choice.starts:
        return None
    if choice.endpoint is not None:
        return choice.endpoint
    places = [parse_endpoint(text) for text in settings.connect]
    if len(places) == 1 and places[0].is_loopback and places[0].is_stream:
        return places[0]
    return None

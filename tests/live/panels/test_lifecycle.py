"""Managed nodes as a panel sees and changes them (row L1)."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

import pytest

from studio.errors import CommandError, NotServedError
from studio.live.connection.ros_connection import RosConnection
from studio.live.panels import lifecycle
from studio.live.panels.lifecycle import LifecycleNodes
from studio.protocol.graph import ChangeState, GetManaged, ManagedNodeView
from studio.settings import WireChoice
from tests.support.managed_arm import managed_arm
from tests.support.wire import PATIENCE_S

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Callable

pytestmark = pytest.mark.network


@asynccontextmanager
async def desk_at(endpoint: str) -> AsyncGenerator[LifecycleNodes]:
    wire = RosConnection(WireChoice("off", (endpoint,)))
    known = LifecycleNodes(wire)
    try:
        await wire.link()
        yield known
    finally:
        await known.let_go()
        await wire.close()


async def seen(known: LifecycleNodes, holds: Callable[[ManagedNodeView], bool]) -> ManagedNodeView:
    async with asyncio.timeout(PATIENCE_S):
        while True:
            for one in (await known.managed(GetManaged())).nodes:
                if holds(one):
                    return one
            await asyncio.sleep(0.02)


def test_l1_a_node_walks_the_four_primary_states(endpoint: str):
    async def run() -> None:
        with managed_arm(endpoint):
            async with desk_at(endpoint) as known:
                now = await seen(known, lambda one: one.state == "unconfigured")
                assert (now.name, now.state_id, now.trouble) == ("/arm", 1, "")
                steps = ("configure", "activate", "deactivate", "cleanup", "shutdown")
                states = ("inactive", "active", "inactive", "unconfigured", "finalized")
                for label, state in zip(steps, states, strict=True):
                    (step,) = (one for one in now.transitions if one.label == label)
                    await known.change(ChangeState(node="/arm", transition=step.id))
                    (now,) = (await known.managed(GetManaged())).nodes
                    assert now.state == state
                assert now.transitions == ()

    asyncio.run(run())


def test_a_node_that_does_not_get_there_is_told_with_where_it_is(endpoint: str):
    async def run() -> None:
        with managed_arm(endpoint) as arm:
            async with desk_at(endpoint) as known:
                await seen(known, lambda one: one.state == "unconfigured")
                await known.change(ChangeState(node="/arm", transition=1))
                arm.stubborn = True
                with pytest.raises(CommandError, match=r"/arm did not .* is in inactive"):
                    await known.change(ChangeState(node="/arm", transition=3))

    asyncio.run(run())


def test_without_a_connection_or_such_a_node_nothing_changes(
    endpoint: str, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(lifecycle, "_CHANGE_S", 0.05)

    async def run() -> None:
        alone = LifecycleNodes(RosConnection(WireChoice("off")))
        assert (await alone.managed(GetManaged(request=6))).request == 6
        with pytest.raises(CommandError, match="Not connected"):
            await alone.change(ChangeState(node="/arm", transition=1))
        async with desk_at(endpoint) as known:
            with pytest.raises(NotServedError):
                await known.change(ChangeState(node="/nobody", transition=1))

    asyncio.run(run())


def test_clients_are_taken_back_when_nobody_looks_any_more(
    endpoint: str, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(lifecycle, "_KEPT_S", 0.01)

    async def run() -> None:
        with managed_arm(endpoint) as arm:
            async with desk_at(endpoint) as known:
                await seen(known, lambda one: one.state_id == 1)
                async with asyncio.timeout(PATIENCE_S):
                    while arm.count_clients("/arm/get_state"):  # noqa: ASYNC110 - no event of it
                        await asyncio.sleep(0.02)

    asyncio.run(run())

"""Nodes at the router of this machine are told of before anybody connects."""

from __future__ import annotations

import asyncio
import subprocess
import sys

import pytest

from studio.live.connection.nearby import nodes_nearby
from studio.live.connection.ros_connection import RosConnection
from studio.settings import WireChoice
from tests.support.demos import node_at
from tests.support.open_documents import Ear, until
from tests.support.wire import free_endpoint

pytestmark = pytest.mark.network


def test_who_is_not_connected_is_told_how_many_nodes_the_router_of_this_machine_has(endpoint: str):
    async def run() -> None:
        with node_at(endpoint):
            wire, ear = RosConnection(WireChoice("off", (endpoint,))), Ear()
            wire.attach(ear)
            await until(lambda: ear.last("wire_state")["nearby_count"] == 1)
            assert ear.last("wire_state")["state"] == "off"
            await wire.link()
            assert ear.last("wire_state")["nearby_count"] == 0
            await wire.disconnect()
            await until(lambda: ear.last("wire_state")["nearby_count"] == 1)
            await wire.close()

    asyncio.run(run())


def test_where_no_router_answers_nobody_is_told_of_and_zenoh_is_not_imported():
    program = (
        "import sys; from studio.live.connection.nearby import nodes_nearby; "
        "from studio.settings import WireChoice; "
        f"count = nodes_nearby(WireChoice('auto', ('{free_endpoint()}',))); "
        "print(count, 'zenoh' in sys.modules)"
    )
    found = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert found.stdout == "0 False\n"


def test_a_router_of_another_machine_is_not_looked_at():
    assert nodes_nearby(WireChoice("auto", ("tcp/192.0.2.1:7447",))) == 0

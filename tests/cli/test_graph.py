"""Why a command sees no node, where a bridge to DDS is."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.cli.graph import why_empty
from tests.support.dds_bridge import DdsNetwork
from tests.support.wire import open_test_session, running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

pytestmark = pytest.mark.network


@pytest.fixture(scope="module")
def network() -> Generator[DdsNetwork]:
    with DdsNetwork() as made:
        yield made


def test_nodes_behind_a_bridge_of_another_domain_are_counted_and_one_without_nodes_is_said(
    network: DdsNetwork,
):
    with running_router() as endpoint, open_test_session(endpoint) as wire:
        network.bridge(connect=endpoint, domain=5)
        assert wire.bridges.settle()
        wait_until("the bridge", lambda: "no DDS node is seen behind it" in why_empty(wire))
        network.robot("classroom", domain=5)
        wait_until("its nodes", lambda: "3 nodes are in domain 5" in why_empty(wire))

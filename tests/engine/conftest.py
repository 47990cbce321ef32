from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.demos import node_at
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.client import Node


@pytest.fixture(scope="module")
def endpoint() -> Generator[str]:
    """A router for the tests of a module."""
    with running_router() as found:
        yield found


@pytest.fixture
def tester(endpoint: str) -> Generator[Node]:
    """A node of somebody else."""
    with node_at(endpoint) as node:
        yield node

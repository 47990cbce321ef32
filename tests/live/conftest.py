from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.demos import node_at

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.client import Node


@pytest.fixture
def tester(endpoint: str) -> Generator[Node]:
    """A node of somebody else."""
    with node_at(endpoint) as node:
        yield node

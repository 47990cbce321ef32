from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.topic_worlds import MemoryWorld, zenoh_world

if TYPE_CHECKING:
    from collections.abc import Generator

    from tests.support.topic_worlds import World


@pytest.fixture(params=["memory", "zenoh"])
def world(request: pytest.FixtureRequest) -> Generator[World]:
    """A source of topics and those who publish there: each test runs in memory and at a router."""
    if request.param == "memory":
        yield MemoryWorld()
    else:
        with zenoh_world(request.getfixturevalue("endpoint")) as made:
            yield made

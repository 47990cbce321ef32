"""What the browser tests of the 3D view share."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.robots import rover
from tests.support.scene_server import SceneServer

if TYPE_CHECKING:
    from collections.abc import Iterator


@pytest.fixture(scope="module")
def server() -> Iterator[SceneServer]:
    """A server whose scene shows the rover, for one file of tests."""
    with SceneServer() as running:
        running.call(lambda scene: scene.show(rover(), None))
        yield running

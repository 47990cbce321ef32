from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.shared_tab import SharedDemo, SharedTab, shared_demo, shared_tab

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from playwright.sync_api import Browser

    from tests.support.server import RunningStudio
    from tests.support.studio_page import StudioPage


@pytest.fixture(scope="session")
def demo(tmp_path_factory: pytest.TempPathFactory) -> Iterator[SharedDemo]:
    """One running studio for all files that need no other."""
    with shared_demo(tmp_path_factory.mktemp("studio") / "data") as made:
        yield made


@pytest.fixture(scope="module")
def shared(browser: Browser, demo: SharedDemo) -> Iterator[SharedTab]:
    """One tab for a file of tests."""
    with shared_tab(browser, demo) as made:
        yield made


@pytest.fixture
def studio(shared: SharedTab) -> RunningStudio:
    """A running demo as at first; a file whose studio is another has a fixture of its own."""
    return shared.anew()


@pytest.fixture
def data(shared: SharedTab) -> Path:
    """The data folder of that studio."""
    return shared.data


@pytest.fixture
def tab(shared: SharedTab, studio: RunningStudio, request: pytest.FixtureRequest) -> StudioPage:
    """A tab that shows the demo, without the 3D view where a test is marked so."""
    del studio  # as at first, before the tab opens it
    return shared.opened(view=request.node.get_closest_marker("without_view") is None)

"""What every test may ask for: the corpus, a browser, and a data folder that is nobody's home."""

from __future__ import annotations

import gc
import os
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, settings

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser, Page

    from tests.support.browser import KeptBrowser

REPOSITORY = Path(__file__).resolve().parents[1]

# Time is asserted in no test: neither that of an example, nor how long a busy machine makes them.
settings.register_profile("studio", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("without sweeps", settings.get_profile("studio"), max_examples=40)


def pytest_configure(config: pytest.Config) -> None:
    """Hypothesis makes fewer examples where sweeps are left out; CI makes as many as it would."""
    left_out = config.option.markexpr == "not sweep"
    settings.load_profile("without sweeps" if left_out else "studio")


@pytest.hookimpl(tryfirst=True)
def pytest_collection(session: pytest.Session) -> None:
    """A parallel run compiles each file of tests once."""
    from tests.support.compiling import import_own_part

    import_own_part(session.config)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Long files begin first, and browsers are spread over a parallel run."""
    from tests.support.order import in_order

    items[:] = in_order(items)


def pytest_xdist_auto_num_workers() -> int:
    """Half as many again as there are processors: a good part of the tests waits for others."""
    return max(2, len(os.sched_getaffinity(0)) * 3 // 2)


def pytest_collection_finish() -> None:
    """What was collected stays to the end: the search for garbage leaves it out.

    What Python compares a new search with is then small, so it would search all the time.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(10_000, 20, 50)


def pytest_runtest_setup(item: pytest.Item) -> None:
    """A sweep over real files has bounded time, and pays for no garbage of the tests before it."""
    if item.get_closest_marker("corpus"):
        gc.collect()


@pytest.fixture(autouse=True, scope="session")
def _own_surroundings(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """No test reads or writes the data folder of whoever runs it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("STUDIO_DATA_DIR", str(tmp_path_factory.mktemp("studio-data")))
        # Hundreds of processes are started: each would compile every module anew.
        patch.delenv("PYTHONDONTWRITEBYTECODE", raising=False)
        yield


@pytest.fixture(scope="session")
def corpus() -> Path:
    """The folder of public robot descriptions; the test is skipped without it."""
    from tests.support import corpus as support

    return support.corpus()


@pytest.fixture(scope="session")
def models() -> Path:
    """The folder of the shipped models."""
    return REPOSITORY / "models"


@pytest.fixture(scope="module")
def endpoint() -> Iterator[str]:
    """The address of a router for one file of tests."""
    from tests.support.wire import running_router

    with running_router() as found:
        yield found


@pytest.fixture(scope="session")
def kept_browser() -> Iterator[KeptBrowser]:
    """The headless Chromium of this process."""
    from tests.support.browser import KeptBrowser

    kept = KeptBrowser()
    yield kept
    kept.close()


@pytest.fixture(scope="module")
def browser(kept_browser: KeptBrowser) -> Iterator[Browser]:
    """A headless Chromium; what a file of tests opens in it, it closes."""
    with kept_browser.lent() as lent:
        yield lent


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    """A fresh page of 1600 x 950 in a context of its own."""
    context = browser.new_context(viewport={"width": 1600, "height": 950})
    context.set_default_timeout(90_000)  # Playwright's own is too little where all cores are busy
    yield context.new_page()
    context.close()

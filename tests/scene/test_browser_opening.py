"""How viser's page with our script opens: a page of its own for each test."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.robots import rover
from tests.support.scene_page import ScenePage

if TYPE_CHECKING:
    from playwright.sync_api import Page

    from tests.support.scene_server import SceneServer

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(180)]


def test_the_robot_is_fitted_again_where_viser_places_its_camera_after_it_came(
    page: Page, server: SceneServer
):
    view = ScenePage(page, server, rover()).open()
    place = view.run("studio3d.getCamera()")["position"]
    view.run("__viserMutable.resetCameraPose(false)")
    view.until(f"Math.hypot(...studio3d.getCamera().position.map((x, n) => x - {place}[n])) < 1e-3")


def test_a_view_in_a_frame_without_the_focus_comes_back_too(page: Page, server: SceneServer):
    view = ScenePage(page, server, rover()).open(framed=True)
    page.evaluate("window.focus()")
    server.drop_connections()
    view.until("heard.filter(([type]) => type === 'connection').length === 2")

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from studio.protocol.roles import Role
from studio.scene import SUBPROTOCOL

if TYPE_CHECKING:
    from tests.support.web_server import RunningWeb

PATH = "/d/small/viser"


def test_the_presenter_may_click_and_the_viewer_only_looks(web: RunningWeb):
    for role, heard in {Role.PRESENTER: b"SceneNodeClickMessage", Role.GUEST: b"end"}.items():
        with web.websocket(PATH, role, subprotocols=(SUBPROTOCOL,)) as lane:
            assert lane.subprotocol == SUBPROTOCOL
            lane.send(b"ShareUrlRequest")
            lane.send(b"SceneNodeClickMessage")
            lane.send(b"ViewerCameraMessage")
            if heard != b"end":
                assert lane.recv(timeout=60) == heard
            assert lane.recv(timeout=60) == b"ViewerCameraMessage"


def test_the_scene_can_end_the_connection(web: RunningWeb):
    with web.websocket(PATH, subprotocols=(SUBPROTOCOL,)) as lane:
        lane.send(b"close")
        with pytest.raises(ConnectionClosed) as closed:
            lane.recv(timeout=60)
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 4000


@pytest.mark.parametrize("offered", [("viser-v0.0.1",), ()])
def test_a_page_of_another_version_is_sent_away_as_viser_does(
    web: RunningWeb, offered: tuple[str, ...]
):
    with web.websocket(PATH, subprotocols=offered) as lane:
        with pytest.raises(ConnectionClosed) as closed:
            lane.recv(timeout=60)
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 1002


def test_a_document_that_is_not_open_has_no_scene(web: RunningWeb):
    with pytest.raises(InvalidStatus) as refused, web.websocket("/d/gone/viser"):
        pass
    assert refused.value.response.status_code == 404

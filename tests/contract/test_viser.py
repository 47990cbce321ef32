"""What of viser's inside we lean on: a new version that moves it fails here, by name."""

# pyright: reportPrivateUsage=false, reportUnknownMemberType=false, reportUnknownArgumentType=false
from __future__ import annotations

import asyncio
import dataclasses
import inspect
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import viser
import viser.infra
import zstandard
from viser import _messages
from viser.infra import _infra
from viser.infra._async_message_buffer import AsyncMessageBuffer

from studio.scene import SUBPROTOCOL, viser_client
from studio.scene.graph import PROPS_OF
from studio.scene.host import make_server
from studio.scene.node import PointCloudProps
from studio.scene.wire import Encoder
from tests.support.viser_frames import messages_of

CLIENT = Path(viser.__file__).parent / "client" / "src"


def test_the_installed_version_is_the_one_that_is_pinned():
    assert f"viser-v{viser.__version__}" == SUBPROTOCOL


def test_the_buffer_has_what_the_host_reads():
    fields = {field.name for field in dataclasses.fields(AsyncMessageBuffer)}
    assert fields >= {
        "message_event",
        "message_counter",
        "message_from_id",
        "buffer_lock",
        "max_window_size",
        "atomic_counter",
        "generator_cursors",
    }
    assert callable(AsyncMessageBuffer.remove_entity_state_from_buffer)


def test_the_server_is_built_as_the_host_builds_it():
    wanted = {"host", "port", "message_class", "http_server_root", "verbose"}
    assert set(inspect.signature(viser.infra.WebsockServer).parameters) >= wanted
    assert list(inspect.signature(_infra._message_producer).parameters)[:3] == [
        "websocket",
        "buffer",
        "client_id",
    ]


def test_no_public_tunnel_can_be_asked_for():
    async def scenario() -> None:
        server, hosted = make_server(asyncio.get_running_loop())
        assert not {_messages.ShareUrlRequest, _messages.ShareUrlDisconnect} & set(
            hosted._incoming_handlers
        )
        server.stop()
        await asyncio.sleep(0)

    asyncio.run(scenario())


@pytest.mark.parametrize(
    "message",
    [
        _messages.SetPositionMessage("/a", (1.0, 2.0, 3.0)),
        _messages.SetOrientationMessage("/a", (1.0, 0.0, 0.0, 0.0)),
    ],
)
def test_our_short_way_to_encode_a_pose_says_what_visers_long_way_does(
    message: _messages.Message,
):
    [ours] = messages_of(Encoder().frame([message]))
    theirs = message.as_serializable_dict([])
    assert ours == {key: list(v) if isinstance(v, tuple) else v for key, v in theirs.items()}


def test_our_short_way_to_encode_a_new_node_says_what_visers_long_way_does():
    points = np.ones((2, 3), np.float32)
    colors = np.zeros(3, np.uint8)
    props = PointCloudProps(points, colors, 0.1, "circle", "float32", 1.0, "flat", 0.5)
    message = _messages.PointCloudMessage("/a", props)
    [ours] = messages_of(Encoder().frame([message]))
    assert ours == message.as_serializable_dict([])


@pytest.mark.parametrize("kind", PROPS_OF, ids=lambda kind: kind.__name__)
def test_every_kind_of_node_that_we_draw_is_one_of_visers(kind: type[_messages.Message]):
    assert kind.lifecycle_phase == "create"
    assert dataclasses.fields(PROPS_OF[kind])  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("file", "texts"),
    [
        ("App.tsx", ["w.__viserMutable = mutable.current", "w.__viserSceneTree"]),
        (
            "WebsocketInterface.tsx",
            ["viewerMutable.firstMessageBatch = true", "document.hasFocus()"],
        ),
        ("messageQueue.ts", ["queue.push(message)"]),
        ("ThreeAssets.tsx", ["gl_FragColor = vec4(col, 1.0);", "(scale / -world_pos.z)"]),
        ("CameraControls.tsx", ["cameraControls.rotate(", "camera_control.getTarget(lookAt)"]),
        ("label/LabelRenderer.tsx", ["-(viewMatrix * vec4(labelPos, 1.0)).z"]),
        ("patchLineMaterial.ts", ["VISER_LINE_FRINGE", "alpha = opacity *"]),
        (
            "label/LabelRenderer.tsx",
            ["vec4(1.0, 1.0, 1.0, 0.85 * vAlpha)", "vec4(0.0, 0.0, 0.0, a)", "group.add(bg)"],
        ),
        ("Grid.tsx", ["return 1.0 - min(line, 1.0);", "fadeDistance"]),
        ("ViewerContext.ts", ["nodeRefFromName", "cameraControl", "requestRender", "messageQueue"]),
        ("ViewerContext.ts", ["nodePoseData: NodePoseDataMap", '"needsUpdate"', "wxyz: "]),
    ],
)
def test_the_page_has_the_hooks_that_our_script_hangs_on(file: str, texts: list[str]):
    source = (CLIENT / file).read_text()
    assert [text for text in texts if text not in source] == []


@pytest.mark.parametrize(
    "text",
    [
        "cross( start.xyz, worldDir )",
        "cross( end.xyz, worldDir )",
        "vec3 rayEnd = normalize( worldPos.xyz ) * 1e5;",
        "vec3( 0.0, 0.0, 0.0 ), rayEnd",
        "vec3 p2 = rayEnd * params.y;",
        "get reversedDepth()",
        "uniform bool isOrthographic;",
    ],
)
def test_the_client_draws_as_our_camera_without_perspective_knows_it(text: str):
    assert text.encode() in client()


@cache
def client() -> bytes:
    return zstandard.ZstdDecompressor().decompressobj().decompress(viser_client())

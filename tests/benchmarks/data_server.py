# pyright: basic
"""Others that hand a topic on to browsers, and who publishes it: a process of its own each.

`python -m tests.benchmarks.data_server KIND ZENOH_PORT [RATE BYTES TOPICS]`: KIND is `naive`,
`foxglove` or `empty`, which print `port N` when they answer; or `publish`, for which the rest is.
"""

from __future__ import annotations

import asyncio
import sys
import time
from functools import partial
from typing import Final

import uvicorn
from fastapi import FastAPI, WebSocket, WebSocketDisconnect

from studio.ros.cdr import Codec
from studio.ros.messages import message
from studio.ros.node.context import Context
from studio.ros.node.node import Node
from studio.ros.qos import QoSProfile
from tests.benchmarks.data_browsers import STAMP_AT, STAMP_DIGITS
from tests.support.wire import free_port, open_test_session

STRING: Final = "std_msgs/msg/String"
TOPICS_MAX: Final = 4
FOREVER_S: Final = 600.0


def topic(number: int) -> str:
    """The name of a topic that is measured."""
    return f"/measured/t{number}"


def publish(zenoh_port: int, rate_hz: int, size: int, topics: int) -> None:
    """Publish texts evenly on each topic, until somebody ends it; each says when it was sent."""
    context = Context.over(open_test_session(f"tcp/127.0.0.1:{zenoh_port}"), owns_wire=True)
    node = Node("source", context=context, enable_rosout=False)
    kind, qos = message(STRING), QoSProfile(depth=100)
    publishers = [node.create_publisher(kind, topic(number), qos) for number in range(topics)]
    text = bytearray(Codec(kind).encode(kind(data="." * size)))
    _say_port(0)
    began_s, number = time.monotonic(), 0
    while time.monotonic() < began_s + FOREVER_S:
        for publisher in publishers:
            text[STAMP_AT : STAMP_AT + STAMP_DIGITS] = b"%020d" % time.monotonic_ns()
            publisher.publish(text)
        number += 1
        time.sleep(max(0.0, began_s + number / rate_hz - time.monotonic()))


def _hear(zenoh_port: int, take) -> object:  # noqa: ANN001
    """Zenoh's own callback, as a bridge of few lines has it; `take(topic's number, sample)`."""
    session = open_test_session(f"tcp/127.0.0.1:{zenoh_port}")
    return session, [
        session.zenoh.declare_subscriber(f"0{topic(number)}/*/*", partial(take, number))
        for number in range(TOPICS_MAX)
    ]


def empty(zenoh_port: int) -> None:
    """Take in all and do nothing with it."""
    kept = _hear(zenoh_port, lambda *_: None)
    _say_port(0)
    time.sleep(FOREVER_S)
    del kept


def naive(zenoh_port: int) -> None:
    """A plain FastAPI loop: each message is awaited for each browser."""

    app, port = FastAPI(), free_port()
    queues: set[asyncio.Queue[bytes]] = set()

    @app.websocket("/data")
    async def data(socket: WebSocket) -> None:
        await socket.accept()
        queue: asyncio.Queue[bytes] = asyncio.Queue(1000)
        queues.add(queue)
        sending = asyncio.create_task(_send_all(socket, queue))
        try:
            while True:
                await socket.receive_text()
        except WebSocketDisconnect:
            queues.discard(queue)
            sending.cancel()

    def give(payload: bytes) -> None:
        for queue in queues:
            if queue.full():
                queue.get_nowait()
            queue.put_nowait(payload)

    async def serve() -> None:
        loop = asyncio.get_running_loop()
        kept = _hear(
            zenoh_port,
            lambda _, sample: loop.call_soon_threadsafe(give, sample.payload.to_bytes()),
        )
        config = uvicorn.Config(app, port=port, log_level="error", ws_per_message_deflate=False)
        _say_port(port)
        await uvicorn.Server(config).serve()
        del kept

    asyncio.run(serve())


async def _send_all(socket: WebSocket, queue: asyncio.Queue[bytes]) -> None:
    while True:
        await socket.send_bytes(await queue.get())


def foxglove(zenoh_port: int) -> None:
    """The WebSocket server of foxglove-sdk."""
    import foxglove as sdk  # pyright: ignore[reportMissingImports]

    port = free_port()
    server = sdk.start_server(host="127.0.0.1", port=port)
    schema = sdk.Schema(name=STRING, encoding="ros2msg", data=b"string data")
    channels = [
        sdk.Channel(topic(number), message_encoding="cdr", schema=schema)
        for number in range(TOPICS_MAX)
    ]
    kept = _hear(zenoh_port, lambda number, sample: channels[number].log(sample.payload.to_bytes()))
    _say_port(port)
    time.sleep(FOREVER_S)
    del kept, server


def _say_port(port: int) -> None:
    sys.stdout.write(f"port {port}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    kinds = {"publish": publish, "naive": naive, "foxglove": foxglove, "empty": empty}
    kinds[sys.argv[1]](*map(int, sys.argv[2:]))

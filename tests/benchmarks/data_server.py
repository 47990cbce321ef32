# pyright: basic
"""Others that hand a topic on to browsers, and who publishes it: a process of its own each.

`python -m tests.benchmarks.data_server naive|foxglove|empty|publish ZENOH_PORT NUMBER [BYTES]`: a
server prints `port N` when it answers; NUMBER is the rate for `publish`, and else of no account.
"""

from __future__ import annotations

import asyncio
import sys
import time

import uvicorn
from fastapi import FastAPI, WebSocket, WebSocketDisconnect

from studio.ros.messages import message
from studio.ros.node.context import Context
from studio.ros.node.node import Node
from studio.ros.qos import QoSProfile
from tests.support.wire import free_port, open_test_session

STRING, TOPIC = "std_msgs/msg/String", "/measured"
FOREVER_S = 600.0


def publish(zenoh_port: int, rate_hz: int, size: int) -> None:
    """Publish texts evenly, until somebody ends it."""
    context = Context.over(open_test_session(f"tcp/127.0.0.1:{zenoh_port}"), owns_wire=True)
    node = Node("source", context=context, enable_rosout=False)
    publisher = node.create_publisher(message(STRING), TOPIC, QoSProfile(depth=100))
    text = message(STRING)(data="." * size)
    sys.stdout.write("port 0\n")
    sys.stdout.flush()
    began_s, number = time.monotonic(), 0
    while time.monotonic() < began_s + FOREVER_S:
        publisher.publish(text)
        number += 1
        time.sleep(max(0.0, began_s + number / rate_hz - time.monotonic()))


def _hear(zenoh_port: int, take) -> object:  # noqa: ANN001
    """Zenoh's own callback, as a bridge of few lines has it."""
    session = open_test_session(f"tcp/127.0.0.1:{zenoh_port}")
    key = f"0{TOPIC}/*/*"
    return session, session.zenoh.declare_subscriber(key, take)


def empty(zenoh_port: int) -> None:
    """Take in all and do nothing with it."""
    kept = _hear(zenoh_port, lambda _: None)
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
            lambda sample: loop.call_soon_threadsafe(give, sample.payload.to_bytes()),
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
    channel = sdk.Channel(TOPIC, message_encoding="cdr", schema=schema)
    kept = _hear(zenoh_port, lambda sample: channel.log(sample.payload.to_bytes()))
    _say_port(port)
    time.sleep(FOREVER_S)
    del kept, server


def _say_port(port: int) -> None:
    sys.stdout.write(f"port {port}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    kind, given_port, number = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    if kind == "publish":
        publish(given_port, number, int(sys.argv[4]))
    else:
        {"naive": naive, "foxglove": foxglove, "empty": empty}[kind](given_port)

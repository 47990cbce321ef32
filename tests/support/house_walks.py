"""Two walks through the house: `python -m tests.support.house_walks`.

A slider's new value, from the control lane to the 3D lane, and a ROS message, from Zenoh to the
data lane. Both are done many times in a running studio, and the files that ran each time, in the
studio or in a worker, are the walk. Of the message it is said, too, which forms it took and what
held it.
"""

from __future__ import annotations

import json
import os
import shutil
import sys
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from studio.ros.messages import message
from studio.ros.node.context import Context
from studio.ros.node.node import Node
from tests.support.sample_forms import follow_sample
from tests.support.server import running_process
from tests.support.wire import open_test_session, running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator

    from websockets.sync.connection import Connection

    from tests.support.server import RunningStudio

REPOSITORY: Final = Path(__file__).resolve().parents[2]
_RECORDER: Final = Path(__file__).with_name("walk_recorder.py")
STEPS: Final = 12
"""What happens at the first few times only is no part of a walk, nor what happens by chance."""
_WARM: Final = 4
_QUIET_S: Final = 0.15
_REST_S: Final = 1.0
"""From one edit to the next: what is checked when it has been quiet is no part of either."""
_PATIENCE_S: Final = 60.0
_STRING: Final = "std_msgs/msg/String"


class Recorder:
    """Where a studio writes down which files run in which step."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        (folder / "step").write_bytes(b"\0")

    @contextmanager
    def step(self, number: int) -> Generator[None]:
        """What runs meanwhile is of this step."""
        self._say(number)
        try:
            yield
        finally:
            self._say(0)

    def _say(self, number: int) -> None:
        with (self._folder / "step").open("r+b") as file:
            file.write(bytes([number]))

    def files(self) -> list[str]:
        """Those that ran in every step after the first few."""
        steps = {number: set[str]() for number in range(_WARM + 1, STEPS + 1)}
        for walk in self._folder.glob("*.walk"):
            for line in walk.read_text().splitlines():
                number, _, file = line.partition(" ")
                if int(number) in steps:
                    steps[int(number)].add(file)
        always = [one for one in steps[STEPS] if all(one in files for files in steps.values())]
        return sorted(Path(one).relative_to(REPOSITORY).as_posix() for one in always)


@contextmanager
def _recorded(*options: str) -> Generator[tuple[RunningStudio, Recorder]]:
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        (folder / "python").mkdir()
        shutil.copy(_RECORDER, folder / "python" / "sitecustomize.py")
        recorder = Recorder(folder)
        before = dict(os.environ)
        os.environ |= {"STUDIO_WALK": scratch, "PYTHONPATH": str(folder / "python")}
        command = ["studio", *options, "--no-browser", "--port", "0"]
        command += ["--data-dir", str(folder / "data")]
        try:
            with running_process(command, folder / "stderr") as studio:
                yield studio, recorder
        finally:
            os.environ.clear()
            os.environ.update(before)


def _received(lane: Connection) -> Iterator[str | bytes]:
    """What comes until nothing has come for a moment."""
    while True:
        try:
            yield lane.recv(timeout=_QUIET_S)
        except TimeoutError:
            return


def slider_walk() -> list[str]:
    """Files that a slider's new value goes through."""
    entry = REPOSITORY / "models" / "rover_description" / "urdf" / "rover.urdf.xacro"
    with _recorded("open", str(entry)) as (studio, recorder):
        with studio.client() as client:
            (document,) = client.get("/api/documents").json()["documents"]
        control, scene = (
            studio.websocket("/control"),
            studio.websocket(f"/d/{document['id']}/viser", "viser-v1.1.1"),
        )

        def send(kind: str, **fields: object) -> None:
            control.send(json.dumps({"type": kind, "document": document["id"], **fields}))

        send("watch")
        site = _site_of(control, "wheel_radius")
        time.sleep(1)
        for _ in _received(scene):
            pass
        for number in range(1, STEPS + 1):
            text = f"{site['number'] * (1 + 0.01 * number):.5f}"
            with recorder.step(number):
                send("edit_site", site=site["id"], text=text, gesture="walk")
                scene.recv(timeout=_PATIENCE_S)
            for lane in (control, scene):
                for _ in _received(lane):
                    pass
            time.sleep(_REST_S)
        control.close()
        scene.close()
        return recorder.files()


def _site_of(control: Connection, name: str) -> dict[str, Any]:
    while True:
        event = control.recv(timeout=_PATIENCE_S)
        if isinstance(event, str) and (told := json.loads(event))["type"] == "sites":
            for site in told["changed"]:
                if site["name"] == name:
                    return site


def message_walk() -> list[str]:
    """Files that a message of another node goes through on its way to a browser."""
    with (
        running_router() as endpoint,
        _recorded("demo", "--connect", endpoint) as (studio, recorder),
    ):
        context = Context.over(open_test_session(endpoint), owns_wire=True)
        node = Node("walker", context=context, enable_rosout=False)
        publisher = node.create_publisher(message(_STRING), "/walk", 10)
        control, data = studio.websocket("/control"), studio.websocket("/data")
        control.send(json.dumps({"type": "connect_wire", "address": endpoint}))
        data.send(
            json.dumps({"type": "subscribe", "subscription": 1, "topic": "/walk", "mode": "every"})
        )
        wait_until("it is subscribed", lambda: publisher.get_subscription_count() > 0)
        for number in range(1, STEPS + 1):
            for _ in _received(data):
                pass
            with recorder.step(number):
                publisher.publish(message(_STRING)(data=str(number)))
                while not isinstance(data.recv(timeout=_PATIENCE_S), bytes):
                    pass
        data.close()
        control.close()
        context.shutdown()
        return recorder.files()


def main() -> None:
    """Print both walks, and what a message becomes on its own."""
    for name, files in (("slider", slider_walk()), ("message", message_walk())):
        sys.stdout.write(f"== {name}: {len(files)} files\n")
        sys.stdout.writelines(f"  {file}\n" for file in files)
    with running_router() as endpoint:
        for browser, slow in (("keeps up", False), ("is slow", True)):
            followed = follow_sample(endpoint, slow=slow)
            sys.stdout.write(f"== message to a browser that {browser}\n")
            sys.stdout.write(f"  forms made by: {', '.join(followed.forms)}\n")
            sys.stdout.write(f"  buffers: {', '.join(sorted(followed.buffers))}\n")


if __name__ == "__main__":
    main()

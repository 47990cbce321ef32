"""An engine with one open robot at a real router, and a node that is the robot's own."""

from __future__ import annotations

import math
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

from studio.documents.engine import Engine
from studio.ros.messages import message
from studio.settings import REWIND_BYTES, Settings, WireChoice
from tests.support.open_documents import opened

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Callable
    from pathlib import Path

    from studio.documents.document import Document
    from studio.protocol import Command
    from studio.ros.client import Node, Publisher
    from tests.support.open_documents import Ear


ARM = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="reach" value="0.5"/>
  <link name="base"/><link name="upper"/><link name="tip"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="mount" type="fixed"><parent link="upper"/><child link="tip"/>
    <origin xyz="${reach} 0 0"/></joint>
</robot>"""
STRING, TF, STATES = "std_msgs/msg/String", "tf2_msgs/msg/TFMessage", "sensor_msgs/msg/JointState"


class Studio:
    """An engine with one open robot, and a page's ear at both."""

    def __init__(self, engine: Engine, document: Document, ear: Ear) -> None:
        self.engine, self.document, self.ear = engine, document, ear

    async def do(self, command: Command) -> None:
        asked = command.model_copy(update={"document": self.document.id})
        await self.engine.execute(asked, self.ear)

    def position(self, joint: str) -> float:
        return self.document.model.joints.by_name()[joint]


@asynccontextmanager
async def studio(
    endpoint: str, folder: Path, *, rewind_bytes: int = REWIND_BYTES
) -> AsyncGenerator[Studio]:
    """The arm, open in an engine that joins the router when asked to."""
    file = folder / "arm.urdf.xacro"
    file.write_text(ARM)
    wire = WireChoice("off", (endpoint,))
    settings = Settings(data_folder=folder / "data", wire=wire, rewind_bytes=rewind_bytes)
    settings.data_folder.mkdir(exist_ok=True)
    made = Engine(settings)
    try:
        document, ear = await opened(made, file)
        made.attach(ear)
        made.rejoin()
        yield Studio(made, document, ear)
    finally:
        await made.close()


def states_out(tester: Node) -> Publisher:
    return tester.create_publisher(message(STATES), "/joint_states", 10)


def joint_states_of(tester: Node) -> Callable[[float], bool]:
    """Tells a position; False, for it is asked for until it has come."""
    out = states_out(tester)

    def tell(position: float) -> bool:
        out.publish(message(STATES)(name=["shoulder", "strange"], position=[position, 0.0]))
        return False

    return tell


def tf_of(tester: Node) -> Callable[[float], bool]:
    out = tester.create_publisher(message(TF), "/tf", 10)
    stamped = message("geometry_msgs/msg/TransformStamped")

    def tell(position: float) -> bool:
        one = stamped(child_frame_id="upper")
        one.header.frame_id = "base"
        turn = one.transform.rotation
        turn.z, turn.w = math.sin(position / 2), math.cos(position / 2)
        out.publish(message(TF)(transforms=[one]))
        return False

    return tell

"""How the parts of a robot are, as the newest of each was heard on /diagnostics."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from studio.live.connection.ros_connection import RosConnection
from studio.live.panels import diagnostics
from studio.live.panels.diagnostics import PartDiagnostics, Parts
from studio.protocol.diagnostics import GetDiagnostics
from studio.ros.cdr import codec_of
from studio.ros.messages import message
from studio.settings import WireChoice
from tests.support.memory_source import MemorySource
from tests.support.wire import PATIENCE_S

if TYPE_CHECKING:
    from studio.ros.client import Node
    from studio.ros.types.classes import MessageValue

ARRAY = message("diagnostic_msgs/msg/DiagnosticArray")
STATUS = message("diagnostic_msgs/msg/DiagnosticStatus")
PAIR = message("diagnostic_msgs/msg/KeyValue")


def said(*parts: tuple[str, int]) -> MessageValue:
    values = [PAIR(key="temperature", value="71")]
    return ARRAY(
        status=[
            STATUS(name=name, level=level, message="as it is", hardware_id="hw-1", values=values)
            for name, level in parts
        ]
    )


def test_the_newest_of_each_part_is_kept_with_its_age():
    now_s = 10.0
    parts = Parts(lambda: now_s)
    parts.take(said(("motor", 2), ("arm", 0)))
    now_s = 12.0
    parts.take(said(("motor", 1)))
    now_s = 15.5
    views, more = parts.views()
    assert [(one.name, one.level, one.age_s) for one in views] == [
        ("arm", 0, 5.5),
        ("motor", 1, 3.5),
    ]
    assert more == 0
    motor = views[1]
    assert (motor.hardware, motor.message) == ("hw-1", "as it is")
    assert [(one.key, one.value) for one in motor.values] == [("temperature", "71")]


def test_parts_and_values_without_end_are_bounded(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(diagnostics, "PARTS_MAX", 2)
    monkeypatch.setattr(diagnostics, "VALUES_MAX", 3)
    parts = Parts()
    many = [PAIR(key=str(at), value="x" * 5_000) for at in range(50)]
    parts.take(ARRAY(status=[STATUS(name=f"part {at}", values=many) for at in range(9)]))
    views, more = parts.views()
    assert (len(views), more) == (2, 2)
    assert len(views[0].values) == 3
    assert len(views[0].values[0].value) == 1_000


def test_parts_of_another_connection_are_forgotten_once_there_is_a_new_one():
    source = MemorySource()
    motor = source.offer("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray")
    told = PartDiagnostics(source)

    def names() -> list[str]:
        return [one.name for one in told.diagnostics(GetDiagnostics()).parts]

    assert names() == []
    motor.say(bytes(codec_of(ARRAY).encode(said(("motor", 2)))))
    assert names() == ["motor"]
    source.connect("none")
    assert names() == ["motor"]
    source.connect()
    assert names() == []
    motor.say(bytes(codec_of(ARRAY).encode(said(("arm", 0)))))
    assert names() == ["arm"]


@pytest.mark.network
def test_they_are_heard_from_the_first_question_on(endpoint: str, tester: Node):
    out = tester.create_publisher(ARRAY, "/diagnostics", 10)

    async def run() -> None:
        wire = RosConnection(WireChoice("off", (endpoint,)))
        shown = PartDiagnostics(wire.topics)
        try:
            assert not (shown.diagnostics(GetDiagnostics(request=8))).connected
            await wire.link()
            async with asyncio.timeout(PATIENCE_S):
                while not (answer := shown.diagnostics(GetDiagnostics())).parts:
                    out.publish(said(("motor", 2)))
                    await asyncio.sleep(0.02)
            assert answer.connected
            assert [one.name for one in answer.parts] == ["motor"]
        finally:
            await wire.close()

    asyncio.run(run())

from __future__ import annotations

import asyncio
from typing import get_args

from studio.live.connection.desk import WireDesk
from studio.live.panels.desk import WORK, BridgeDesk
from studio.protocol import BridgeCommand
from studio.protocol.interfaces import GetInterface, InterfaceAnswer
from studio.settings import WireChoice
from tests.support.open_documents import Ear


def test_every_command_of_the_bridge_has_its_work():
    assert set(WORK) == set(get_args(BridgeCommand) or (BridgeCommand,))


def test_the_asker_is_answered():
    desk = BridgeDesk(WireDesk(WireChoice()))
    asked = GetInterface(request=1, name="std_msgs/msg/String")
    answer = asyncio.run(desk.carry_out(asked, Ear()))
    assert isinstance(answer, InterfaceAnswer)
    assert answer.kind == "msg"

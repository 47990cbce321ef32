from __future__ import annotations

import pytest
from websockets.frames import Frame, Opcode

from studio.web.protocol import Framer


@pytest.mark.parametrize("length", [0, 1, 125, 126, 65_535, 65_536, 200_000])
@pytest.mark.parametrize("binary", [True, False])
def test_a_frame_is_as_the_websocket_library_writes_it(length: int, binary: bool):
    payload = b"x" * length
    expected = Frame(Opcode.BINARY if binary else Opcode.TEXT, payload).serialize(mask=False)
    assert Framer().frame(payload, binary=binary) == expected


def test_of_a_message_to_many_one_frame_is_made():
    framer, payload = Framer(), b"a message"
    first = framer.frame(payload, binary=True)
    assert framer.frame(payload, binary=True) is first
    assert framer.frame(payload, binary=False) != first
    assert framer.frame(b"another", binary=True).endswith(b"another")

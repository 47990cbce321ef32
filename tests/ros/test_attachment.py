from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import AttachmentError
from studio.ros.attachment import ATTACHMENT_BYTES, Attachment, unpack

GID = bytes(range(16))


def test_an_attachment_is_written_byte_for_byte():
    packed = Attachment(1, 1_700_000_000_000_000_000, GID).pack()
    assert packed.hex() == "010000000000000000002a36fe9c971710" + GID.hex()
    assert len(packed) == ATTACHMENT_BYTES == 33


@given(st.integers(0, 2**63 - 1), st.integers(0, 2**63 - 1), st.binary(min_size=16, max_size=16))
def test_any_attachment_survives(sequence: int, time_ns: int, gid: bytes):
    attachment = Attachment(sequence, time_ns, gid)
    assert unpack(attachment.pack()) == attachment


def test_the_old_form_is_known_by_name():
    def text(word: bytes) -> bytes:
        return bytes([len(word)]) + word

    old = text(b"sequence_number") + bytes(8) + text(b"source_timestamp") + bytes(8)
    old += text(b"source_gid") + b"\x10" + GID
    with pytest.raises(AttachmentError, match="before 2025"):
        unpack(old)


@pytest.mark.parametrize("data", [None, b"", b"x", bytes(33), bytes(32), bytes(34)])
def test_what_is_no_attachment_is_refused(data: bytes | None):
    with pytest.raises(AttachmentError):
        unpack(data)


@pytest.mark.parametrize(("sequence", "time_ns"), [(-1, 0), (0, -1)])
def test_numbers_below_zero_are_refused(sequence: int, time_ns: int):
    with pytest.raises(AttachmentError, match="below zero"):
        unpack(Attachment(sequence, time_ns, GID).pack())


@given(st.binary(max_size=80))
def test_any_bytes_are_an_attachment_or_refused_by_name(data: bytes):
    try:
        assert unpack(data).pack() == data
    except AttachmentError:
        return

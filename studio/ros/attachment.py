"""The attachment of every sample, request and reply: number, time and sender."""

from __future__ import annotations

import struct
from typing import NamedTuple

from studio.errors import AttachmentError

GID_BYTES = 16
_LAYOUT = struct.Struct(f"<qqB{GID_BYTES}s")
ATTACHMENT_BYTES = _LAYOUT.size
# Releases before 2025 name each part: the first string begins with its length.
_OLD_FORM = b"\x0fsequence_number"


class Attachment(NamedTuple):
    """Sent with every sample; a tuple, for it is made fastest.

    `sequence` counts the messages of one endpoint from 1, `source_time_ns` is since the Unix
    epoch, `gid` names the endpoint. A reply repeats the sequence and GID of its request.
    """

    sequence: int
    source_time_ns: int
    gid: bytes

    def pack(self) -> bytes:
        """Write the 33 bytes."""
        return packed(self.sequence, self.source_time_ns, self.gid)


def packed(sequence: int, source_time_ns: int, gid: bytes) -> bytes:
    """Return the 33 bytes of an attachment."""
    return _LAYOUT.pack(sequence, source_time_ns, GID_BYTES, gid)


def unpack(data: bytes | None) -> Attachment:
    """Read an attachment.

    Raises:
        AttachmentError: It is missing, in the old form, or none of rmw_zenoh's.
    """
    if data is None or len(data) != ATTACHMENT_BYTES:
        raise AttachmentError(_misfit(data))
    sequence, source_time_ns, gid_bytes, gid = _LAYOUT.unpack(data)
    if gid_bytes != GID_BYTES or sequence < 0 or source_time_ns < 0:
        raise AttachmentError("its number, time or length is below zero or wrong")
    return Attachment(sequence, source_time_ns, gid)


def _misfit(data: bytes | None) -> str:
    if not data:
        return "it came without one, which no rmw_zenoh does"
    if data.startswith(_OLD_FORM):
        return "its sender is an rmw_zenoh from before 2025 that names each part: update the sender"
    return f"it has {len(data)} bytes instead of {ATTACHMENT_BYTES}"

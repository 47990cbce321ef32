"""Records of MCAP: their layout, and the small ones read with every length checked."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.bags.blocks import Channel, Definition
from studio.errors import DamagedPartError

if TYPE_CHECKING:
    from collections.abc import Iterator

MAGIC: Final = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX = 1, 2, 3, 4, 5, 6, 7
CHUNK_INDEX, ATTACHMENT, METADATA, STATISTICS, DATA_END = 8, 9, 12, 11, 15
OPCODES: Final = range(1, 16)
"""The opcodes that the MCAP specification defines."""
PRIVATE: Final = 0x80
"""From here on they are a user's own."""
HEAD: Final = struct.Struct("<BQ")
"""Of each record: opcode and length of what follows."""
MESSAGE_HEAD: Final = struct.Struct("<BQHIqq")
"""Of a message: opcode, length, channel, sequence, log time, publish time."""
MESSAGE_FIELDS_BYTES: Final = MESSAGE_HEAD.size - HEAD.size
FOOTER_RECORD: Final = struct.Struct("<BQQQI")
TAIL_BYTES: Final = FOOTER_RECORD.size + len(MAGIC)
CHUNK_HEAD: Final = struct.Struct("<qqQII")
"""Of a chunk after opcode and length: begin, end, bytes inside, CRC, length of the name."""
CHUNK_HEAD_BYTES: Final = HEAD.size + CHUNK_HEAD.size + 64
"""What stands before the data of a chunk is no longer."""
_COUNT: Final = struct.Struct("<HQ")
U16, U32, U64 = struct.Struct("<H"), struct.Struct("<I"), struct.Struct("<Q")
TEXT_BYTES_MAX: Final = 2**20
"""Of a schema, or of what stands with a channel."""


class Fields:
    """Reads the fields of one record, one after another."""

    def __init__(self, data: bytes | memoryview) -> None:
        self._data = data
        self._at = 0

    def number(self, layout: struct.Struct) -> int:
        """Read a number."""
        return self._numbers(layout)[0]

    def _numbers(self, layout: struct.Struct) -> tuple[int, ...]:
        if self._at + layout.size > len(self._data):
            raise DamagedPartError("a record ends in the middle of a number")
        found = layout.unpack_from(self._data, self._at)
        self._at += layout.size
        return found

    def numbers(self, form: str) -> tuple[int, ...]:
        """Read several, by a form of `struct`."""
        return self._numbers(struct.Struct(form))

    def raw(self, length: int) -> bytes:
        """Read so many bytes."""
        if length > len(self._data) - self._at:
            raise DamagedPartError("a record ends in the middle of a field")
        found = bytes(self._data[self._at : self._at + length])
        self._at += length
        return found

    def text(self) -> str:
        """Read a text after its length."""
        length = self.number(U32)
        if length > TEXT_BYTES_MAX:
            raise DamagedPartError(f"a text has {length} bytes")
        return self.raw(length).decode(errors="replace")

    def beginning(self) -> str:
        """Read a text after its length; of one that is too long, the beginning."""
        data = self.raw(self.number(U32))
        return data[:TEXT_BYTES_MAX].decode(errors="replace")

    def texts(self) -> dict[str, str]:
        """Read a map of texts."""
        end = self.number(U32) + self._at
        found: dict[str, str] = {}
        while self._at < end:
            key = self.text()
            found[key] = self.text()
        return found


class Schema(NamedTuple):
    """A type as a file defines it."""

    key: int
    definition: Definition


class ChannelRecord(NamedTuple):
    """A channel as it is written."""

    key: int
    schema: int
    topic: str
    encoding: str
    metadata: dict[str, str]


class Chunk(NamedTuple):
    """What stands before the data of a chunk."""

    begin_ns: int
    end_ns: int
    size: int
    crc: int
    compression: str
    data_at: int
    """Where its data begins, counted from the record."""
    stored: int
    """Bytes of its data."""


def read_schema(data: bytes | memoryview) -> Schema:
    """Read the content of a schema.

    Raises:
        DamagedPartError: It is none.
    """
    fields = Fields(data)
    key = fields.number(U16)
    # One that is too long to be read costs its own topics, and not the index of the file.
    return Schema(key, Definition(fields.text(), fields.text(), fields.beginning()))


def read_channel(data: bytes | memoryview) -> ChannelRecord:
    """Read the content of a channel.

    Raises:
        DamagedPartError: It is none.
    """
    fields = Fields(data)
    key, schema = fields.numbers("<HH")
    return ChannelRecord(key, schema, fields.text(), fields.text(), fields.texts())


def read_chunk(data: bytes | memoryview) -> Chunk:
    """Read what stands before the data of a chunk, from the opcode on.

    Raises:
        DamagedPartError: It is none.
    """
    fields = Fields(data[:CHUNK_HEAD_BYTES])
    opcode, length = fields.numbers("<BQ")
    begin_ns, end_ns, size, crc, name_length = fields.numbers("<qqQII")
    if opcode != CHUNK or name_length > 32:
        raise DamagedPartError("there is no chunk")
    name = fields.raw(name_length).decode(errors="replace")
    stored = fields.number(U64)
    data_at = HEAD.size + CHUNK_HEAD.size + name_length + U64.size
    if HEAD.size + length != data_at + stored:
        raise DamagedPartError("the lengths of a chunk disagree")
    return Chunk(begin_ns, end_ns, size, crc, name, data_at, stored)


def read_metadata_record(data: bytes | memoryview) -> dict[str, str]:
    """Return what a record of metadata holds, if it is the one of rosbag2.

    Raises:
        DamagedPartError: It is none.
    """
    fields = Fields(data)
    return fields.texts() if fields.text() == "rosbag2" else {}


def read_statistics(data: bytes | memoryview) -> tuple[int, int, dict[int, int]]:
    """Return the numbers of messages, of chunks, and of messages of each channel.

    Raises:
        DamagedPartError: There are none.
    """
    fields = Fields(data)
    messages, _schemas, _channels, _attachments, _metadata, chunks = fields.numbers("<QHIIII")
    fields.numbers("<QQ")
    pairs = fields.raw(fields.number(U32))
    if len(pairs) % _COUNT.size:
        raise DamagedPartError("the counts of channels are cut off")
    return messages, chunks, dict(_COUNT.iter_unpack(pairs))


def records(data: bytes | memoryview) -> Iterator[tuple[int, int, int]]:
    """Yield opcode, begin and end of the content of each record.

    Raises:
        DamagedPartError: One goes beyond the end; those before it were yielded.
    """
    at, end = 0, len(data)
    while at < end:
        if at + HEAD.size > end:
            raise DamagedPartError("it ends in the middle of a record")
        opcode, length = HEAD.unpack_from(data, at)
        at += HEAD.size
        if length > end - at:
            raise DamagedPartError("a record in it goes beyond its end")
        yield opcode, at, at + length
        at += length


def as_channel(record: ChannelRecord, schemas: dict[int, Definition], count: int | None) -> Channel:
    """Return a channel with the type that its schema names."""
    definition = schemas.get(record.schema)
    return Channel(
        record.key,
        record.topic,
        definition.type_name if definition else "",
        record.encoding,
        record.metadata.get("topic_type_hash", ""),
        record.metadata.get("offered_qos_profiles", ""),
        count,
    )

from __future__ import annotations

import struct

import pytest

from studio.errors import CdrError
from studio.ros.columns.layout import BytesReader, BytesWriter

NAME = "p/msg/T"


def test_what_was_written_is_read_in_its_places():
    writer = BytesWriter(NAME)
    writer.text("é")
    writer.word(7)
    at = writer.numbers(8, 16)
    reader = BytesReader(bytes(writer.written), NAME)
    assert (reader.text(), reader.word(), reader.numbers(8, 16)) == ("é", 7, at)
    assert (at - 4) % 8 == 0
    assert reader.at == len(writer.written)


def test_the_header_says_the_order():
    big = b"\0\0\0\0" + struct.pack(">I", 258)
    little = b"\0\1\0\0" + struct.pack("<I", 258)
    assert BytesReader(big, NAME).word() == BytesReader(little, NAME).word() == 258


@pytest.mark.parametrize("raw", [b"", b"\0", b"\0\1", b"\0\7\0\0", b"\1\1\0\0\0\0\0\0"])
def test_what_has_no_header_of_plain_cdr_is_refused(raw: bytes):
    with pytest.raises(CdrError, match="header"):
        BytesReader(raw, NAME)


@pytest.mark.parametrize(
    "text", [b"\0\0\0\0", b"\xff\xff\xff\xff", b"\2\0\0\0ab", b"\2\0\0\0\xff\0", b"\1\0"]
)
def test_a_text_that_is_none_is_refused(text: bytes):
    with pytest.raises(CdrError):
        BytesReader(b"\0\1\0\0" + text, NAME).text()


def test_numbers_beyond_the_end_are_refused():
    with pytest.raises(CdrError, match="end in the middle"):
        BytesReader(b"\0\1\0\0" + bytes(7), NAME).numbers(8, 8)

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.errors import CdrError, MessageValueError
from studio.ros.cdr import Codec
from studio.ros.columns.transforms import TYPE_NAME, TransformCodec
from studio.ros.types.library import TypeLibrary
from studio.tf.transforms import TransformColumns
from tests.support.fast_values import assert_same, transform_columns
from tests.support.ros_values import values_of

LIBRARY = TypeLibrary("jazzy")
TF = LIBRARY.message(TYPE_NAME)
CODEC = Codec(TF)
FAST = TransformCodec()


def columns(*children: str, x: float = 0.0) -> TransformColumns:
    count = len(children)
    return TransformColumns(
        ("base",) * count,
        children,
        np.arange(count, dtype=np.int64) * 10**9 + 7,
        np.full((count, 3), x),
        np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)),
    )


@settings(max_examples=80, deadline=None)
@given(values_of(TF), st.booleans())
def test_any_message_reads_as_the_codec_reads_it(value: Any, little: bool):  # noqa: ANN401
    written = CODEC.encode(value, little_endian=little)
    for codec in (TransformCodec(), FAST, FAST):
        assert_same(codec.decode(written), transform_columns(CODEC.decode(written)))


@settings(max_examples=80, deadline=None)
@given(values_of(TF))
def test_what_was_read_is_written_as_it_was(value: Any):  # noqa: ANN401
    for one in value.transforms:
        one.header.stamp.nanosec %= 10**9
    read = FAST.decode(CODEC.encode(value))
    again = CODEC.decode(FAST.encode(read))
    assert_same(transform_columns(again), read)


def test_other_numbers_under_the_same_names_are_read_anew():
    fast = TransformCodec()
    first = fast.decode(fast.encode(columns("a", "b", x=1.0)))
    second = fast.decode(fast.encode(columns("a", "b", x=2.0)))
    assert first.translations.tolist() == [[1.0] * 3] * 2
    assert second.translations.tolist() == [[2.0] * 3] * 2
    assert second.children is first.children


def test_other_names_of_the_same_length_are_not_taken_for_those_before():
    fast = TransformCodec()
    for child in ("left", "rite", "left", "tail", "nose", "ears"):
        assert fast.decode(fast.encode(columns(child))).children == (child,)


def test_numbers_that_look_like_lengths_change_no_name():
    fast = TransformCodec()
    fast.decode(fast.encode(columns("a", "b")))
    hostile = columns("a", "b", x=float(np.frombuffer(b"\xff" * 7 + b"\x7f", "<f8")[0]))
    assert fast.decode(fast.encode(hostile)).children == ("a", "b")


@pytest.mark.parametrize("cut", range(4, 180, 7))
def test_a_message_that_ends_too_early_is_refused(cut: int):
    whole = bytes(TransformCodec().encode(columns("a", "b")))
    with pytest.raises(CdrError, match=r"TFMessage"):
        TransformCodec().decode(whole[:cut])


@settings(max_examples=300, deadline=None)
@given(st.sampled_from([b"", b"\0\1\0\0", b"\0\0\0\0"]), st.binary(max_size=300))
def test_any_bytes_are_read_as_the_codec_reads_them_or_refused_with_it(head: bytes, body: bytes):
    assert_alike(head + body)


@settings(max_examples=300, deadline=None)
@given(st.integers(0, 400), st.integers(0, 255))
def test_a_byte_that_changed_is_read_as_the_codec_reads_it_or_refused_with_it(at: int, byte: int):
    raw = bytearray(TransformCodec().encode(columns("wheel", "arm", "x")))
    raw[at % len(raw)] = byte
    assert_alike(bytes(raw))


def assert_alike(raw: bytes) -> None:
    try:
        expected = transform_columns(CODEC.decode(raw))
    except CdrError:
        with pytest.raises(CdrError):
            FAST.decode(raw)
        return
    assert_same(FAST.decode(raw), expected)


def test_a_count_that_no_bytes_follow_is_refused_at_once():
    with pytest.raises(CdrError, match="4294967295 items"):
        TransformCodec().decode(b"\0\1\0\0" + b"\xff" * 200)


def test_bytes_behind_the_last_transform_are_passed_over():
    fast = TransformCodec()
    raw = bytes(fast.encode(columns("a")))
    assert fast.decode(raw + b"more").children == ("a",)


@pytest.mark.parametrize(
    "wrong",
    [
        replace(columns("a"), stamps_ns=np.zeros(2, dtype=np.int64)),
        replace(columns("a"), translations=np.zeros((1, 4))),
        replace(columns("a"), children=("a", "b")),
        replace(columns("a"), stamps_ns=np.array([2**62])),
        replace(columns("a"), children=("\ud800",)),
    ],
)
def test_columns_that_do_not_fit_are_not_sent(wrong: TransformColumns):
    with pytest.raises(MessageValueError, match=r"TFMessage"):
        TransformCodec().encode(wrong)


def test_a_time_before_the_epoch_survives():
    fast = TransformCodec()
    early = replace(columns("a"), stamps_ns=np.array([-1]))
    assert fast.decode(fast.encode(early)).stamps_ns.tolist() == [-1]


def test_ever_new_names_fill_no_memory():
    fast = TransformCodec()
    for number in range(500):
        fast.decode(fast.encode(columns(f"{'x' * (number % 90)}{number}")))
    assert fast.layouts_kept <= 16 * 4

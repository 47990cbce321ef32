"""The last minutes: what keeping a message costs the thread that receives it, and the past itself.

Small messages at 10 kHz and images of 6 MB at 30 Hz, until the memory is full several times; then
the moment of all topics, as a drag of the bar asks for it.
"""

from __future__ import annotations

import random
import time
from typing import Final

from studio.live.time.past import Inbox, LivePast
from studio.live.topics.request import Fit
from studio.ros.attachment import Attachment
from studio.ros.messages import shared_types
from studio.ros.node.samples import RawSample
from tests.benchmarks.report import judge, say

_BEGIN_NS: Final = 1_700_000_000_000_000_000
_SIZE_BYTES: Final = 256 << 20
_SMALL_BYTES: Final = 200
_TOPICS: Final = 50
_BATCH: Final = 100
_MESSAGES: Final = 2_000_000
_IMAGE: Final = bytes(6_000_000)
_IMAGES: Final = 900
_MOMENTS: Final = 300


def run() -> None:
    """Keep much of both, and look back."""
    past = LivePast(_SIZE_BYTES, shared_types)
    past.keep(keeping=True)
    _keep_small(past)
    _keep_images(past)
    _look_back(past)


def _inboxes(past: LivePast, names: list[str]) -> list[Inbox]:
    fit = Fit("std_msgs/msg/String", "RIHS01_1", True, False, 10)
    return [past.begin(name, fit, tuple) for name in names]


def _keep_small(past: LivePast) -> None:
    inboxes = _inboxes(past, [f"/small_{number}" for number in range(_TOPICS)])
    put_ns = kept_ns = 0
    for first in range(0, _MESSAGES, _BATCH):
        inbox = inboxes[first // _BATCH % _TOPICS]
        samples = [_sample(bytes(_SMALL_BYTES), first + at, 100_000) for at in range(_BATCH)]
        begin_ns = time.perf_counter_ns()
        inbox.put(samples)
        put_ns += time.perf_counter_ns() - begin_ns
        if first % (_BATCH * 10) == 0:
            begin_ns = time.perf_counter_ns()
            past.collect()
            kept_ns += time.perf_counter_ns() - begin_ns
    put_us, kept_us = put_ns / _MESSAGES / 1_000, kept_ns / _MESSAGES / 1_000
    span_s = (past.end_ns - past.begin_ns) / 1e9
    say(
        f"{_MESSAGES:,} messages of {_SMALL_BYTES} bytes: {put_us:.3f} us each to put away, "
        f"{kept_us:.2f} us to keep; {past.size >> 20} MB hold {span_s:.0f} s of 10 kHz"
    )
    judge("a kept message costs its receiver", put_us, at_most=1.0, unit="us")
    judge("and the past", kept_us, at_most=10.0, unit="us")


def _keep_images(past: LivePast) -> None:
    (inbox,) = _inboxes(past, ["/camera"])
    begin_ns = time.perf_counter_ns()
    for number in range(_IMAGES):
        inbox.put([_sample(_IMAGE, _MESSAGES + number * 333, 100_000)])
        past.collect()
    each_us = (time.perf_counter_ns() - begin_ns) / _IMAGES / 1_000
    camera = next(one for one in past.topics if one.name == "/camera")
    say(
        f"{_IMAGES} images of {len(_IMAGE) / 1e6:.0f} MB: {each_us:.0f} us each to keep; "
        f"{camera.count} of them are left, in {past.size >> 20} MB"
    )
    judge("the memory stays within its bound", past.size / _SIZE_BYTES, at_most=1.0, unit="of it")


def _look_back(past: LivePast) -> None:
    rng = random.Random(1)
    names = [one.name for one in past.topics]
    begin_ns, end_ns = past.begin_ns, past.end_ns
    before_ns = time.perf_counter_ns()
    for _ in range(_MOMENTS):
        past.latest(names, rng.randint(begin_ns, end_ns))
    each_ms = (time.perf_counter_ns() - before_ns) / _MOMENTS / 1e6
    say(f"the moment of {len(names)} topics: {each_ms:.2f} ms")
    judge("a moment of the past", each_ms, at_most=5.0, unit="ms")


def _sample(payload: bytes, number: int, every_ns: int) -> RawSample:
    at_ns = _BEGIN_NS + number * every_ns
    return RawSample(payload, Attachment(number, at_ns, b"a" * 16), at_ns)

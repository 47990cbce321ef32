"""One content in every storage and compression: one answer, as it was recorded."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING

import pytest
import zstandard

from studio.bags.opening import open_bag
from tests.support.bag_oracle import ROSBAGS, write_rosbags
from tests.support.bags import BEGIN_NS, Chunks, McapForm, write_raw_mcap

if TYPE_CHECKING:
    from pathlib import Path

    from studio.bags.bag import Bag
    from tests.support.written_bags import Told

TOPICS = ("/chatter", "/empty/payloads", "/large")
ANSWER = "cf8a60cc9e1da7a524b803bb671f4260a8cacfd321e027f73a2e695ad0eb6e4f"
"""Topics, types, counts, definitions, stamps and bytes, as sha256."""


def content() -> list[Told]:
    """Messages whose stamps stand still and go back at times; empty ones, and large ones."""
    made: list[Told] = []
    for number in range(300):
        stamp = BEGIN_NS + number // 2 * 1_000_000 - (5_000_000 if number % 50 == 49 else 0)
        digest = hashlib.sha256(str(number).encode()).digest()
        payload = (b"\0\1\0\0" + digest[: number % 32], b"", b"\0\1\0\0" + digest * 500)[number % 3]
        made.append((TOPICS[number % 3], stamp, payload))
    return made


def answer(bag: Bag) -> str:
    """Everything that a bag says of its messages, as one number."""
    whole = hashlib.sha256()
    for topic in bag.topics:
        about = (
            topic.name,
            topic.type_name,
            topic.encoding,
            topic.count,
            topic.trouble,
            topic.note,
        )
        whole.update(f"{about}{bag.types.hash_of(topic.type_name)}\n".encode())
    whole.update(f"{bag.begin_ns} {bag.end_ns} {list(bag.troubles)}\n".encode())
    for topic, sample in bag.messages(TOPICS, 0, 2**62):
        whole.update(f"{topic} {sample.received_ns} {len(sample.payload)}\n".encode())
        whole.update(sample.payload)
    for topic in TOPICS:
        whole.update(bag.counts(topic, BEGIN_NS, BEGIN_NS + 200_000_000, 17).tobytes())
    return whole.hexdigest()


def _by_mcap(folder: Path, manner: str) -> Path:
    chunks = Chunks[manner.removesuffix(", packed").upper()]
    file = write_raw_mcap(folder / "bag.mcap", content(), McapForm(chunks, chunk_bytes=20_000))
    if not manner.endswith("packed"):
        return file
    packed = folder / "bag.mcap.zstd"
    packed.write_bytes(zstandard.compress(file.read_bytes()))
    return packed


@pytest.mark.parametrize("manner", ["none", "zstd", "lz4", "none, packed", "zstd, packed"])
def test_what_mcap_wrote_is_answered_as_recorded(tmp_path: Path, manner: str):
    bag = open_bag(_by_mcap(tmp_path, manner), kept_in=tmp_path / "kept")
    assert answer(bag) == ANSWER
    bag.close()


@pytest.mark.parametrize("manner", ROSBAGS)
def test_what_rosbags_wrote_is_answered_as_recorded(tmp_path: Path, manner: str):
    bag = open_bag(write_rosbags(tmp_path / "bag", content(), manner), kept_in=tmp_path / "kept")
    assert answer(bag) == ANSWER
    bag.close()

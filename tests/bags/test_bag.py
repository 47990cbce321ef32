"""Every answer of a bag is that of the libraries' own readers, whoever wrote it and however."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from hypothesis import given, settings
from hypothesis import strategies as st

from studio.bags.compression import ZSTD_MAGIC
from studio.bags.opening import open_bag
from tests.support.bag_oracle import (
    ROSBAGS,
    Oracle,
    check_all_answers,
    oracle_of_mcap,
    oracle_of_rosbags,
    write_rosbags,
)
from tests.support.bags import BEGIN_NS, Chunks, McapForm, write_raw_mcap

if TYPE_CHECKING:
    from tests.support.written_bags import Told

LAST_NS = 20
TOLD = st.lists(
    st.tuples(
        st.sampled_from(["/a", "/b/c", ""]),
        st.integers(BEGIN_NS, BEGIN_NS + LAST_NS),
        # Without metadata.yaml, the first bytes of the first message tell whether it is compressed.
        st.binary(max_size=60).filter(lambda one: not one.startswith(ZSTD_MAGIC)),
    ),
    max_size=40,
)
FORMS = st.builds(
    McapForm,
    chunks=st.sampled_from(Chunks),
    chunk_bytes=st.sampled_from([1, 150, 400, 10_000]),
    chunked=st.sampled_from([True, True, True, False]),
    indexed=st.booleans(),
)


@settings(max_examples=30)
@given(TOLD, FORMS)
def test_what_mcap_wrote_answers_as_its_own_reader(told: list[Told], form: McapForm):
    with tempfile.TemporaryDirectory() as folder:
        file = write_raw_mcap(Path(folder) / "bag.mcap", told, form)
        bag = open_bag(file, kept_in=Path(folder) / "kept")
        try:
            check_all_answers(bag, oracle_of_mcap(file), LAST_NS)
        finally:
            bag.close()


@settings(max_examples=30)
@given(TOLD, st.sampled_from(sorted(ROSBAGS)))
def test_what_rosbags_wrote_answers_as_its_own_reader(told: list[Told], manner: str):
    with tempfile.TemporaryDirectory() as folder:
        path = write_rosbags(Path(folder) / "bag", told, manner)
        bag = open_bag(path, kept_in=Path(folder) / "kept")
        try:
            check_all_answers(bag, oracle_of_rosbags(path), LAST_NS)
            assert not bag.troubles
        finally:
            bag.close()


@settings(max_examples=30)
@given(st.lists(TOLD, min_size=2, max_size=3), st.sampled_from(["mcap", "sqlite3"]))
def test_files_that_overlap_in_time_answer_as_one(parts: list[list[Told]], manner: str):
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "bag").mkdir()
        for number, told in enumerate(parts):
            one = write_rosbags(Path(folder) / f"one_{number}", told, manner)
            (file,) = (file for file in one.iterdir() if file.name != "metadata.yaml")
            file.rename(Path(folder) / "bag" / f"bag_{number}{file.suffix}")
        bag = open_bag(Path(folder) / "bag", kept_in=Path(folder) / "kept")
        try:
            check_all_answers(bag, Oracle(_in_order(parts)), LAST_NS)
        finally:
            bag.close()


def _in_order(parts: list[list[Told]]) -> list[Told]:
    """All messages; of those of one time, the ones of the file that begins first come first."""
    times = [[at_ns for _, at_ns, _ in told] or [0] for told in parts]
    order = sorted(range(len(parts)), key=lambda i: (min(times[i]), max(times[i]), i))
    return [one for i in order for one in parts[i]]

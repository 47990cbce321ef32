"""Writing a part of a recording into a bag: a cut of a file, or the last minutes in memory."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING, Final

from studio.bags.recording import Recorded, latched_count
from studio.bags.writer import BagWriter
from studio.errors import RecordingError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence
    from pathlib import Path

    from studio.bags.recording import RecordedTopic, Recording
    from studio.bags.writer import Storing, Written

_CDR: Final = "cdr"
_REPORT_EVERY: Final = 500
"""Messages between two reports of progress, unless they are large."""
_REPORT_EVERY_BYTES: Final = 8_000_000


def write_recording(  # noqa: PLR0913 - a part has two ends
    recording: Recording,
    folder: Path,
    topics: Iterable[str],
    begin_ns: int,
    end_ns: int,
    progress: Callable[[float], object],
    *,
    storing: Storing | None = None,
) -> Written:
    """Write the messages of [begin_ns, end_ns) into a new bag, with their times.

    What a late subscriber would have been given at the beginning, the last messages of latched
    topics, comes first, with the time of the beginning: a cut without it would show no robot.

    Args:
        recording: Where they are.
        folder: Of the new bag.
        topics: Names of those that are wanted; empty: all.
        begin_ns: ns since the Unix epoch; `end_ns` likewise.
        end_ns: Behind the last message.
        progress: Is told the share that is done, 0 to 1; what it raises ends the writing, and no
            bag is left.
        storing: How it is written.

    Raises:
        BagNotWrittenError: There is something at the path, or the disk refuses it.
        RecordingError: There is no such topic, or the range is empty.
    """
    chosen = _chosen(recording, topics)
    if end_ns <= begin_ns:
        raise RecordingError("The end of the part comes before its beginning: give a later end.")
    writer = BagWriter(folder, recording.types, storing)
    try:
        numbers = {topic.name: writer.add_topic(topic) for topic in chosen}
        untold = untold_bytes = 0
        for topic, sample in _messages(recording, chosen, begin_ns, end_ns):
            writer.write(numbers[topic], sample)
            untold, untold_bytes = untold + 1, untold_bytes + len(sample.payload)
            if untold >= _REPORT_EVERY or untold_bytes >= _REPORT_EVERY_BYTES:
                untold = untold_bytes = 0
                progress((sample.received_ns - begin_ns) / (end_ns - begin_ns))
        progress(1.0)
        return writer.close()
    except BaseException:
        writer.abandon()
        shutil.rmtree(writer.path, ignore_errors=True)
        raise


def _messages(
    recording: Recording, topics: Sequence[RecordedTopic], begin_ns: int, end_ns: int
) -> Iterator[Recorded]:
    """Yield what topics had latched at the beginning, as of then, and the messages since."""
    for topic in topics:
        if topic.is_latched:
            for sample in recording.last(topic.name, begin_ns - 1, latched_count(topic)):
                yield Recorded(topic.name, sample._replace(received_ns=begin_ns))
    yield from recording.messages([one.name for one in topics], begin_ns, end_ns)


def _chosen(recording: Recording, topics: Iterable[str]) -> list[RecordedTopic]:
    known = {one.name: one for one in recording.topics}
    names = list(dict.fromkeys(topics))
    missing = [name for name in names if name not in known]
    if missing:
        raise RecordingError(
            f"It has no topic {missing[0][:200]}: studio bag info names those that it has."
        )
    foreign = [name for name in names if known[name].encoding != _CDR]
    if foreign:
        raise RecordingError(
            f'{foreign[0][:200]} is in the form "{known[foreign[0]].encoding[:40]}": only messages '
            "of ROS 2 are written."
        )
    return [known[name] for name in names or known if known[name].encoding == _CDR]

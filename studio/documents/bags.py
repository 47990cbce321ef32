"""Bags as documents: opened, shown in an open document, or with the robot that is in them."""

from __future__ import annotations

import asyncio
import hashlib
import os
import time
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.errors import CdrError, CommandError, StudioError
from studio.files import is_file, is_folder
from studio.live.time.recorded_robot import DESCRIPTION
from studio.live.time.shown import ShownRecording
from studio.packages.manifest import FILE_NAME as MANIFEST
from studio.packages.received_texts import choose_packages, keep_description
from studio.packages.workspace import bare_location

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.bags.bag import Bag
    from studio.bags.recording import Recording
    from studio.packages.index import PackageIndex
    from studio.packages.workspace import Location

_SUFFIXES: Final = (".mcap", ".db3", ".mcap.zstd", ".db3.zstd")
_METADATA: Final = "metadata.yaml"
_LISTED_MAX: Final = 1_000
_STRING: Final = "std_msgs/msg/String"
_TF: Final = ("/tf_static", "/tf")
_TF_READ: Final = 2_000
_TF_NS: Final = 10_000_000_000
_NO_FRAME: Final = "map"
_TELL_EVERY_S: Final = 0.2


def is_bag(path: Path) -> bool:
    """Return whether a path is a bag's: its folder, or a file of one; reads the disk."""
    if path.name == _METADATA and is_file(path):
        return is_bag(path.parent)
    if not is_folder(path):
        return path.name.lower().endswith(_SUFFIXES) and is_file(path)
    if is_file(path / MANIFEST):
        return False
    try:
        with os.scandir(path) as found:
            names = [one.name for one, _ in zip(found, range(_LISTED_MAX), strict=False)]
    except OSError:
        return False
    return any(one.lower().endswith(_SUFFIXES) for one in names)


def bag_in(folder: Path) -> Path | None:
    """Return the bag that a folder without a robot is or has in it, if that is a single one.

    A folder made for a file that was sent, or unpacked, is not the bag: the file has its name.
    """
    if is_bag(folder) and is_file(folder / _METADATA):
        return folder
    try:
        with os.scandir(folder) as found:
            inside = [one.path for one, _ in zip(found, range(_LISTED_MAX), strict=False)]
    except OSError:
        return None
    bags = [Path(one) for one in sorted(inside) if is_bag(Path(one))]
    if len(bags) == 1:
        return bags[0]
    return folder if is_bag(folder) else None


async def bag_instead(location: Location) -> Path | None:
    """Return the bag of a place that holds no robot, such as a zip of one."""
    return None if location.entry else await asyncio.to_thread(bag_in, location.root)


def served_folder(bag: Path) -> Path:
    """Return the folder that is served for a bag."""
    return bag if bag.is_dir() else bag.parent


def folder_of_bag(path: Path) -> Path:
    """Return what a bag is called by: the folder for its `metadata.yaml`."""
    return path.parent if path.name == _METADATA else path


async def opened_bag(path: Path, told: Callable[[float | None], object]) -> ShownRecording:
    """Open a bag, to be let go once.

    Args:
        path: As `is_bag` takes it.
        told: Told how far the reading of a damaged or unfinished file is, 0 to 1, and None when
            it has ended.

    Raises:
        BagNotReadableError: Nothing of it can be read.
    """
    from studio.bags.opening import open_bag  # noqa: PLC0415 - imports mcap

    loop, told_s = asyncio.get_running_loop(), 0.0

    def progress(share: float) -> None:  # in the thread that reads
        nonlocal told_s
        now_s = time.monotonic()
        if now_s - told_s >= _TELL_EVERY_S and not loop.is_closed():
            told_s = now_s
            loop.call_soon_threadsafe(told, share)

    def opened() -> Bag:
        bag = open_bag(path, progress)
        bag.topic(DESCRIPTION)  # with it all topics are found, which takes long where they are many
        return bag

    path = folder_of_bag(path)
    try:
        bag = await asyncio.to_thread(opened)
    finally:
        told(None)
    return ShownRecording(bag, "bag", bag.title, str(path), bag.close)


def location_of_bag(
    shown: ShownRecording, path: Path, frame: str, data_folder: Path, known: Iterable[PackageIndex]
) -> Location | Path:
    """Return the file of the robot that a bag describes, or the place of a bare document.

    Args:
        shown: The bag.
        path: Its folder or file.
        frame: Its `root_frame`.
        data_folder: Where descriptions are kept.
        known: Indexes of open documents, which may have the packages of its meshes.

    Raises:
        StudioError: The data folder cannot take it.
    """
    try:
        text = _description(shown.recording)
        if text:
            digest = hashlib.sha256(os.fsencode(path)).hexdigest()[:8]
            file = keep_description(data_folder, f"{path.stem} {digest}", text)
            choose_packages(data_folder, file, text, known)
            return file
    except StudioError as error:  # then the rest of the bag is shown
        shown.troubles = (f"There is no robot, for {DESCRIPTION} cannot be used: {error}",)
    return bare_location(path, frame or _NO_FRAME, data_folder)


def _description(recording: Recording) -> str:
    """Return the first description of a robot in a recording; empty: it has none.

    Raises:
        StudioError: What is there is none.
    """
    found = recording.topic(DESCRIPTION)
    first_ns = None if found is None else recording.next_ns(DESCRIPTION, recording.begin_ns - 1)
    if found is None or first_ns is None:
        return ""
    if found.type_name != _STRING:
        raise CommandError(f"it is of {found.type_name}, and not of {_STRING}.")
    from studio.ros.cdr import codec_of  # noqa: PLC0415 - takes its time

    sample = recording.latest([DESCRIPTION], first_ns).get(DESCRIPTION)
    if sample is None:
        raise CommandError("its part of the file is damaged.")
    return str(codec_of(recording.types.message(_STRING)).decode(sample.payload).data)


def root_frame(recording: Recording) -> str:
    """Return the frame that most others of a recording hang on; empty: it has no transforms.

    Raises:
        BagNotReadableError: The recording cannot be read.
    """
    from studio.ros.columns.transforms import TransformCodec  # noqa: PLC0415 - takes its time
    from studio.tf.buffer import TransformBuffer  # noqa: PLC0415 - as above

    buffer, codec = TransformBuffer(), TransformCodec()
    known = {one.name for one in recording.topics}
    until_ns = recording.begin_ns + _TF_NS
    for topic in _TF:
        for sample in recording.last(topic, until_ns, _TF_READ) if topic in known else ():
            try:
                buffer.put(codec.decode(sample.payload), static=topic == "/tf_static")
            except CdrError:
                continue
    return next(iter(buffer.roots()), "")


def demand_bag(path: Path) -> None:
    """Pass if a path is a bag's; reads the disk.

    Raises:
        CommandError: It is not.
    """
    if not is_bag(path):
        raise CommandError(
            f"{path.name} is no bag: choose a folder with metadata.yaml, or a .mcap or .db3 file."
        )

"""A robot as a link: its file, arguments and unsaved edits, and a moment of a bag, in one line.

Compressed JSON in base64url, behind a digit that names the format. A link may come from anybody:
it is bounded, names files below the served folders only, and is opened and edited by the ordinary
commands.
"""

from __future__ import annotations

import base64
import hashlib
import json
import zlib
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, NamedTuple

from pydantic import Field, ValidationError

from studio.description.editing.merging import hunks_between
from studio.description.values import Edit
from studio.documents.edits import TEXT_LIMIT_BYTES
from studio.errors import CommandError, EditError, PackageError
from studio.packages.roots import package_folder_of
from studio.packages.run_folders import is_program
from studio.protocol.documents import Link, LinkLook
from studio.protocol.message import ArgumentName, Message

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from studio.description.editing.sources import Sources
    from studio.packages.roots import ServedRoots
    from studio.packages.workspace import Location

LINK_LIMIT: Final = 400_000
"""Characters; browsers take two million, the command lane one."""
_VERSION: Final = "1"
_UNPACKED_BYTES: Final = 2 << 20
_AROUND: Final = 100
"""Bytes of its line around an edit, by which it is found again in a file that differs."""
_GESTURE: Final = "link"

_Text = Annotated[str, Field(max_length=_UNPACKED_BYTES)]
_Name = Annotated[str, Field(max_length=4096)]


class SharedPath(Message):
    """A file by its path, and by its package where it lies in one: another machine has that."""

    path: _Name
    package: _Name = ""
    inside: _Name = ""


class SharedEdit(Message):
    """Replace `old` at byte `at` by `new`; bytes are written as Latin-1 letters."""

    at: int = Field(ge=0, le=1 << 32)
    old: _Text
    new: _Text
    before: _Text = ""
    after: _Text = ""


class SharedFile(Message):
    """The unsaved edits of one file, and the digest of the text that they change."""

    file: SharedPath
    digest: str = Field(max_length=64)
    edits: tuple[SharedEdit, ...] = Field(max_length=10_000)


class SharedMoment(Message):
    """A moment of a bag; `own`: the robot of the link is the bag's own, and opens with it."""

    bag: SharedPath
    at_ns: int = Field(ge=-(1 << 62), le=1 << 62)
    own: bool = False


class SharedRobot(Message):
    """The content of a link."""

    entry: SharedPath
    arguments: dict[ArgumentName, _Text] = Field(default_factory=dict[str, str], max_length=1000)
    files: tuple[SharedFile, ...] = Field(default=(), max_length=200)
    moment: SharedMoment | None = None
    look: LinkLook = LinkLook()


class Moment(NamedTuple):
    """What a document shows of a bag; times in ns since the Unix epoch.

    `own`: the document was opened for the bag.
    """

    bag: Path
    title: str
    begin_ns: int
    at_ns: int
    own: bool


def link_to(
    sources: Sources, location: Location, request: int, look: LinkLook, moment: Moment | None
) -> Link:
    """Return a link that opens a document as it is now.

    Args:
        sources: Its texts.
        location: Where its files lie.
        request: Of the command.
        look: How the page shows it.
        moment: What it shows of a bag.

    Raises:
        CommandError: Its unsaved edits are too many for a link.
    """
    assert location.entry is not None
    files = tuple(_shared_file(sources, location, name) for name in sources.unsaved_files)
    shared = SharedRobot(
        entry=_shared_path(location, location.entry),
        arguments=sources.arguments,
        files=files,
        moment=moment and _shared_moment(location, moment),
        look=look,
    )
    content = shared.model_dump(exclude_defaults=True)
    text = json.dumps(content, separators=(",", ":"), ensure_ascii=False)
    packed = base64.urlsafe_b64encode(zlib.compress(text.encode(), 9)).decode().rstrip("=")
    if len(packed) >= LINK_LIMIT or len(text.encode()) > _UNPACKED_BYTES:
        raise CommandError("The unsaved edits are too many for a link: save them, then copy it.")
    return Link(
        request=request,
        text=f"{_VERSION}{packed}",
        arguments=len(sources.arguments),
        files=sources.unsaved_files,
        edits=sum(len(file.edits) for file in files),
        bag=moment.title if moment else "",
        at_s=(moment.at_ns - moment.begin_ns) / 1e9 if moment else 0.0,
    )


def read_link(text: str) -> SharedRobot:
    """Return the content of a link.

    Raises:
        CommandError: It is no link of this studio, or it is damaged.
    """
    if not text.startswith(_VERSION):
        raise CommandError("The link is of another version of the studio: ask for a new one.")
    try:
        packed = base64.b64decode(text[1:] + "=" * (-len(text[1:]) % 4), b"-_", validate=True)
        reader = zlib.decompressobj()
        unpacked = reader.decompress(packed, _UNPACKED_BYTES)
        if not reader.eof:
            raise CommandError("The link is damaged or too large: ask for it again.")
        return SharedRobot.model_validate_json(unpacked)
    except (ValueError, zlib.error, ValidationError) as error:
        raise CommandError("The link is damaged: copy the whole of it.") from error


def found_again(shared: SharedPath, served: ServedRoots, locations: Iterable[Location]) -> Path:
    """Return the file on this machine that a link means.

    Raises:
        CommandError: It is not below the served folders.
    """
    if served.serves(shared.path) and Path(shared.path).is_file():
        return served.resolve(shared.path)
    for location in locations:
        for folder in location.index.candidates(shared.package, location.root):
            path = folder / shared.inside
            if shared.package and served.serves(path) and path.is_file():
                return served.resolve(path)
    name = f"{shared.package}/{shared.inside}" if shared.package else shared.path
    raise CommandError(f"The link names {name}, which is not in the opened folders: open it first.")


def bag_places(
    shared: SharedPath, bags_folder: Path, locations: Iterable[Location]
) -> Iterator[Path]:
    """Yield where the bag of a link may lie on this machine; nothing of it is looked at."""
    yield Path(shared.path)
    for location in locations:
        for folder in location.index.candidates(shared.package, location.root):
            if shared.package:
                yield folder / shared.inside
    yield bags_folder / Path(shared.path).name


def place_edits(
    sources: Sources, location: Location, files: Sequence[SharedFile]
) -> tuple[tuple[Edit, ...], tuple[str, ...]]:
    """Make a link's edits as one step; what was done, in order, and what found no place."""
    done: list[Edit] = []
    left_out: list[str] = []
    for file in files:
        try:
            path = str(found_again(file.file, location.served, [location]))
            left_out += _edit_file(sources, location, path, file, done)
        except (CommandError, PackageError, EditError) as error:
            left_out.append(str(error))
    return tuple(done), tuple(left_out)


def _edit_file(
    sources: Sources, location: Location, path: str, file: SharedFile, done: list[Edit]
) -> list[str]:
    """Edit one file, the last place first so that the others stay where they are."""
    if is_program(path):
        return [f"{path} is a program, which no link edits: its edits were left out."]
    if not location.served.may_write(path):
        return [f"{path} may only be read here: its edits were left out."]
    sources.track([path])
    text = sources.text(path)
    is_same = _digest(text) == file.digest
    places = [_place(text, edit, exact=is_same) for edit in file.edits]
    found = sorted((at, n) for n, at in enumerate(places) if at is not None)
    if any(at + len(file.edits[n].old) > later for (at, n), (later, _) in pairwise(found)):
        raise EditError(f"{path}: the link's edits overlap; they were left out.")
    for at, n in reversed(found):
        edit = file.edits[n]
        made = Edit(path, at, at + len(edit.old), edit.new.encode("latin-1"))
        if len(sources.text(path)) + len(made.new) > TEXT_LIMIT_BYTES:
            raise EditError(f"{path} would grow too large: the link's edits were left out.")
        sources.edit(made, "Edits of a link", _GESTURE, is_value=False)
        done.append(made)
    missing = len(places) - len(found)
    sentence = f"{Path(path).name} is another one here: {missing} of its edits found no place."
    return [sentence] if missing else []


def _place(text: bytes, edit: SharedEdit, *, exact: bool) -> int | None:
    """Return where an edit applies: at its own place, else the one with the same text around."""
    try:
        old = edit.old.encode("latin-1")
        edit.new.encode("latin-1")
        before, after = edit.before.encode("latin-1"), edit.after.encode("latin-1")
    except UnicodeEncodeError:
        return None
    if exact:
        return edit.at if text[edit.at : edit.at + len(old)] == old else None
    wanted = before + old + after
    at = text.find(wanted)
    if not wanted or at < 0 or text.find(wanted, at + 1) >= 0:
        return None
    return at + len(before)


def _shared_file(sources: Sources, location: Location, name: str) -> SharedFile:
    disk = sources.saved(name)
    edits = tuple(
        SharedEdit(
            at=hunk.start,
            old=_letters(disk[hunk.start : hunk.end]),
            new=_letters(hunk.new),
            before=_letters(disk[: hunk.start][-_AROUND:].rpartition(b"\n")[2]),
            after=_letters(disk[hunk.end : hunk.end + _AROUND].partition(b"\n")[0]),
        )
        for hunk in hunks_between(disk, sources.text(name))
    )
    return SharedFile(file=_shared_path(location, Path(name)), digest=_digest(disk), edits=edits)


def _shared_moment(location: Location, moment: Moment) -> SharedMoment:
    return SharedMoment(bag=_shared_path(location, moment.bag), at_ns=moment.at_ns, own=moment.own)


def _shared_path(location: Location, path: Path) -> SharedPath:
    folder = package_folder_of(path)
    if folder is None:
        return SharedPath(path=str(path))
    packages = location.index.packages
    name = next((one.name for one in packages if one.folder == folder), folder.name)
    return SharedPath(path=str(path), package=name, inside=path.relative_to(folder).as_posix())


def _letters(data: bytes) -> str:
    return data.decode("latin-1")


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:32]

"""Named items of a robot, such as variants and poses, in a YAML file beside its entry file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Generic, Protocol, TypeVar

from studio.description.syntax.named_list import NAME_LIMIT, SIZE_LIMIT_BYTES
from studio.errors import CommandError, DescriptionError, NotSavedError, PackageError
from studio.files import is_there, write_whole

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from studio.packages.roots import ServedRoots


_ENDINGS: Final = (".urdf.xacro", ".xacro", ".urdf", ".xml")


class SideFile:
    """`<robot>.<kind>.yaml` beside the entry file."""

    def __init__(self, entry: Path, kind: str, served: ServedRoots) -> None:
        self.path = entry.with_name(f"{_stem(entry.name)}.{kind}.yaml")
        self._served = served

    @property
    def only_here(self) -> str:
        """Why what belongs in it is kept for this session only; empty: it can be written."""
        if self._served.may_write(self.path):
            return ""
        return f"the folder {self.path.parent} may only be read here."

    def read(self, limit_bytes: int) -> bytes:
        """Return its bytes; none if it does not exist.

        Raises:
            PackageError: It leads out of the opened folders, is no file, or is too large.
        """
        if not is_there(self.path):
            return b""
        return self._served.read(self.path, limit_bytes)

    def write(self, data: bytes) -> None:
        """Whole or not at all: beside it, then renamed over it. A symlink stays.

        Raises:
            PackageError: It leads out of the opened folders.
            NotSavedError: The disk refused it.
        """
        target = self._served.resolve(self.path)
        try:
            mode = target.stat().st_mode & 0o777 if is_there(target) else 0o644
            write_whole(target, data, mode=mode, flush=True)
        except OSError as error:
            reason = error.strerror or "the disk refused it"
            raise NotSavedError(str(self.path), reason) from error


def _stem(name: str) -> str:
    return next((name.removesuffix(end) for end in _ENDINGS if name.endswith(end)), name)


class Named(Protocol):
    """An item of a shelf."""

    @property
    def name(self) -> str:
        """The name that is unique in the file."""
        ...


Item = TypeVar("Item", bound=Named)


@dataclass(frozen=True, slots=True)
class ItemKind(Generic[Item]):
    """The items of a shelf, and how its file is read and written."""

    noun: str
    """Of one item, as `variant`; its plural is in the file's name."""
    read: Callable[[str, bytes], tuple[Item, ...]]
    """The items of a file, from its path and bytes."""
    write: Callable[[str, str, bytes, Sequence[Item]], bytes]
    """The new bytes, from the file's path, the entry's name, the old bytes and the items."""


class NamedItems(Generic[Item]):
    """Reads and writes one file of items; what cannot be written is kept for the session."""

    def __init__(self, entry: Path, served: ServedRoots, kind: ItemKind[Item]) -> None:
        self._entry, self._kind = entry, kind
        self._file = SideFile(entry, f"{kind.noun}s", served)
        self.path = self._file.path
        self._data = b""
        self._here: tuple[Item, ...] | None = None
        """The items of this session, once they could not be written."""
        self.items: tuple[Item, ...] = ()
        self._fault: DescriptionError | PackageError | None = None
        """What is wrong with the file; the last good items stay."""
        self.refresh()

    @property
    def only_here(self) -> str:
        """Why items are kept for this session only; empty: they are saved."""
        return self._file.only_here

    @property
    def trouble(self) -> str:
        """What is wrong with the file, in a sentence."""
        return str(self._fault or "")

    def refresh(self) -> None:
        """Read the file."""
        if self._here is not None:
            return
        try:
            data = self._file.read(SIZE_LIMIT_BYTES)
            if data != self._data or self._fault is not None:
                self._data = data
                self.items, self._fault = self._kind.read(str(self.path), data), None
        except (DescriptionError, PackageError) as error:
            self._fault = error

    def find(self, name: str) -> Item:
        """Return the item of a name, as the file has it now.

        Raises:
            CommandError: There is none.
        """
        self.refresh()
        for one in self.items:
            if one.name == name:
                return one
        raise CommandError(f'There is no {self._kind.noun} "{name}" any more: choose another.')

    def free_name(self, wanted: str) -> str:
        """Return a name for an item, without the blanks around it.

        Raises:
            CommandError: It is empty, too long, of several lines, or taken.
        """
        name, noun = wanted.strip(), self._kind.noun
        if not name or len(name) > NAME_LIMIT or not name.isprintable():
            raise CommandError(f"A {noun} needs a name of one line, up to {NAME_LIMIT} letters.")
        self.refresh()
        if any(one.name == name for one in self.items):
            raise CommandError(f'There is a {noun} "{name}" already: choose another name.')
        return name

    def put(self, items: Sequence[Item]) -> None:
        """Keep these from now on.

        Raises:
            DescriptionError: The file as it is cannot be read: it is not overwritten.
            PackageError: It leads out of the opened folders, or is no file.
            NotSavedError: The disk refused it.
        """
        self.refresh()
        if self._fault is not None:
            raise self._fault
        if self._here is not None or self.only_here:
            self._here = self.items = tuple(items)
            return
        self._file.write(self._kind.write(str(self.path), self._entry.name, self._data, items))
        self.refresh()

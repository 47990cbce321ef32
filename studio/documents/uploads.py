"""Files that a browser sends, kept in the data folder, made to find each other, and opened."""

from __future__ import annotations

import asyncio
import shutil
from contextlib import ExitStack
from typing import TYPE_CHECKING, Final

from studio.documents.bags import bag_in
from studio.errors import DataFolderError, StudioError, UploadError
from studio.files import is_folder
from studio.packages.archive import folder_to_open
from studio.packages.index import load_choices, save_choices
from studio.packages.robot_files import robot_candidates
from studio.packages.roots import ServedRoots
from studio.packages.uploads import Upload, arrange, is_zip, read_manifest
from studio.packages.workspace import unpacked_folder

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Mapping
    from pathlib import Path

    from studio.documents.library import Opener


_WRITTEN_AT_ONCE_BYTES: Final = 1 << 20


class Uploads:
    """Takes what is sent, several at once; each is kept whole or not at all."""

    def __init__(self, data_folder: Path, opener: Opener) -> None:
        self._data_folder, self._opener = data_folder, opener
        self._reserved_bytes = 0
        """Sizes announced by running uploads."""

    async def take(self, manifest: bytes, chunks: AsyncIterator[bytes], beside: str = "") -> str:
        """Keep sent files in the data folder and open them; gives the document's id.

        Args:
            manifest: What `read_manifest` reads.
            chunks: The bytes of all files, one after the other; ends early when it is cancelled.
            beside: The open document that shall show a bag; empty: it gets one of its own.

        Raises:
            StudioError: They cannot be kept, or are no robot; then nothing is left of them.
        """
        files = read_manifest(manifest)
        upload = Upload(self._data_folder, files, self._reserved_bytes)
        self._reserved_bytes += upload.size_bytes
        try:
            with ExitStack() as stack:
                await asyncio.to_thread(stack.enter_context, upload)
                await _write(upload, chunks)
                staged = upload.finish()
                if is_zip(files[0]):
                    return await self._open_zip(staged / files[0].path, beside)
                return await self._open_sent(upload, staged, beside)
        finally:
            self._reserved_bytes -= upload.size_bytes

    async def _open_zip(self, sent: Path, beside: str) -> str:
        """Unpack and open; what holds neither a robot nor a bag is not kept."""
        folder = await asyncio.to_thread(unpacked_folder, sent, self._data_folder)
        is_new = not is_folder(folder)
        try:
            return await self._opener.open_at(sent, {}, None, beside)
        except StudioError:
            if is_new:
                await asyncio.to_thread(shutil.rmtree, folder, ignore_errors=True)
            raise

    async def _open_sent(self, upload: Upload, staged: Path, beside: str) -> str:
        chosen = await asyncio.to_thread(arrange, staged)
        robot = (await asyncio.to_thread(_opened_of, staged)).relative_to(staged)
        kept, is_new = await asyncio.to_thread(upload.keep)
        folder = folder_to_open(kept)
        try:
            self._choose(folder, {name: kept / one for name, one in chosen.items()})
            return await self._opener.open_at(kept / robot, {}, ServedRoots([folder]), beside)
        except StudioError:
            if is_new:
                await asyncio.to_thread(shutil.rmtree, kept, ignore_errors=True)
            raise

    def _choose(self, workspace: Path, chosen: Mapping[str, Path]) -> None:
        """Add packages without a package.xml to the index; earlier choices of a user stay."""
        if not chosen:
            return
        try:
            known = load_choices(self._data_folder, workspace)
            save_choices(self._data_folder, workspace, {**chosen, **known})
        except OSError as error:
            reason = error.strerror or "not kept"
            raise DataFolderError(str(self._data_folder), reason) from error


def _opened_of(folder: Path) -> Path:
    """Return what to open of what was sent: a robot, else a bag.

    Raises:
        UploadError: It holds neither.
    """
    try:
        return _robot_in(folder)
    except UploadError:
        bag = bag_in(folder) or bag_in(folder_to_open(folder))
        if bag is None:
            raise
        return bag


def _robot_in(folder: Path) -> Path:
    """Return what to open of a folder: the part that was dropped, or a broken description.

    Raises:
        UploadError: It holds no description.
    """
    base = folder_to_open(folder)
    found = robot_candidates(base, ServedRoots([base]))
    if any(one.openable for one in found):
        return base
    broken = next((one.path for one in found if one.reason.startswith("not readable")), None)
    if broken is None:
        why = f"{found[0].path.name}: {found[0].reason}" if found else "a .xacro, .urdf or .zip"
        raise UploadError(f"there is no robot description among the files ({why}).")
    return broken


async def _write(upload: Upload, chunks: AsyncIterator[bytes]) -> None:
    """Hand on what comes, in pieces that are worth a thread."""
    held = bytearray()
    async for chunk in chunks:
        held += chunk
        if len(held) >= _WRITTEN_AT_ONCE_BYTES:
            await asyncio.to_thread(upload.write, bytes(held))
            held.clear()
    await asyncio.to_thread(upload.write, bytes(held))

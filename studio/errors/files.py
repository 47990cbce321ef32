"""Errors of settings, folders, packages and files."""

from __future__ import annotations

from studio.errors.root import StudioError


class SettingsError(StudioError):
    """The command line or the environment asks for something that cannot be."""


class PortTakenError(SettingsError):
    """The port that was asked for by number is held by another program."""

    def __init__(self, host: str, port: int) -> None:
        super().__init__(
            f"Port {port} on {host} is taken by another program: choose another --port."
        )
        self.host, self.port = host, port


class DataFolderError(SettingsError):
    """The data folder cannot be made or written."""

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(f"The data folder {path} cannot be used ({reason}): choose --data-dir.")
        self.path, self.reason = path, reason


class UnsafeKeyError(SettingsError):
    """Others may know the key that proves who may present, or gave it."""

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(
            f"The file {path} {reason}, and who knows it can open this studio: delete it, or "
            "choose another --data-dir."
        )
        self.path, self.reason = path, reason


class PackageError(StudioError):
    """A package, a file of one, or a folder of them is not as it must be."""


class PackageNotFoundError(PackageError):
    """No package of that name lies below the folders that may be read."""

    def __init__(self, name: str, asked_by: str | None = None) -> None:
        where = f"{asked_by}: " if asked_by else ""
        super().__init__(
            f'{where}package "{name}" was not found below the opened folders: '
            "choose its folder or give --package-path."
        )
        self.name, self.asked_by = name, asked_by


class OutsideRootsError(PackageError):
    """A path leads out of the folders that may be read, symlinks resolved."""

    def __init__(self, path: str) -> None:
        super().__init__(
            f"{path} lies outside the opened folders and was not read: "
            "open a folder that holds it or give --package-path."
        )
        self.path = path


class UnreadableFileError(PackageError):
    """A file is missing, no regular file, too large, or of no known encoding."""

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(f"{path}: {reason}")
        self.path, self.reason = path, reason


class UnsafeArchiveError(PackageError):
    """A zip would write outside its folder, or unpack to more than it may."""

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(f"{path} was not unpacked: {reason}")
        self.path, self.reason = path, reason


class NotMadeError(PackageError):
    """A new file or package cannot be made."""

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(f"{path} was not made: {reason}")
        self.path, self.reason = path, reason


class UploadError(PackageError):
    """Files that were sent to the studio cannot be taken; nothing of them is kept."""

    def __init__(self, reason: str) -> None:
        super().__init__(f"Nothing was uploaded: {reason}")
        self.reason = reason


class ExportError(PackageError):
    """A robot or its package cannot be given out."""

    def __init__(self, what: str, reason: str) -> None:
        super().__init__(f"{what} was not exported: {reason}.")
        self.what, self.reason = what, reason

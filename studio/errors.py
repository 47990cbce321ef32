"""Every error the studio raises, in one tree.

StudioError
    SettingsError
        PortTakenError
        DataFolderError
    PackageError
        PackageNotFoundError
        OutsideRootsError
        UnreadableFileError
        UnsafeArchiveError
        ExportError
        NotMadeError
        UploadError
    DescriptionError
        ExpansionError
            RefusedError
        EditError
            StaleEditError
            StaleTextError
            ReadOnlyTextError
            SaveConflictError
            NotSavedError
            DraftError
        VariantsFileError
        PosesFileError
    RobotError
        MeshError
    SceneError
    WireError
        WireSettingsError
        NoRouterError
        RosNameError
        TokenError
        AttachmentError
        InterfaceError
            InterfaceTextError
            UnknownTypeError
        MessageValueError
        CdrError
    WorkerError
        WorkerTimeoutError
        WorkerDiedError
    AccessError
        NotAllowedError
    CommandError
        UnknownDocumentError
        SupersededError

Each keeps its data and says in one sentence what is wrong, where, and what to do.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from studio.problems import Problem


class StudioError(Exception):
    """Anything that the studio can say in one sentence; the root of the tree."""


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


class DescriptionError(StudioError):
    """A robot description cannot be expanded, edited or saved."""


class ExpansionError(DescriptionError):
    """Xacro could not expand a file; `problem` holds the place, include chain and macro stack."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(str(problem))
        self.problem = problem


class RefusedError(ExpansionError):
    """A file asked for something unsafe or over budget; final, no other evaluator is tried."""


class EditError(DescriptionError):
    """An edit cannot be applied as asked."""


class StaleEditError(EditError):
    """The site is no longer where the asker saw it."""

    def __init__(self, site: str) -> None:
        super().__init__(
            f"{site} is no longer in the source: the file was changed meanwhile, edit it again."
        )
        self.site = site


class StaleTextError(EditError):
    """An edit was made on a text that has changed since the editor saw it."""

    def __init__(self, file: str) -> None:
        super().__init__(f"{file} was changed meanwhile: load its text again.")
        self.file = file


class ReadOnlyTextError(EditError):
    """A text that may be read only was to be edited."""

    def __init__(self, file: str, reason: str) -> None:
        super().__init__(f"{file} cannot be edited: {reason}")
        self.file, self.reason = file, reason


class SaveConflictError(EditError):
    """The file on disk is no longer the one that was read."""

    def __init__(self, path: str) -> None:
        super().__init__(
            f"{path} was changed on disk since it was read and was not overwritten: "
            "reload it first."
        )
        self.path = path


class NotSavedError(EditError):
    """A file cannot be written; nothing of it was."""

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(f"{path} was not saved: {reason}.")
        self.path, self.reason = path, reason


class DraftError(EditError):
    """Unsaved edits cannot be kept against the end of the studio, or not be taken up again."""

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(
            f"Unsaved edits in {path} cannot be kept or brought back: {reason}; save what matters."
        )
        self.path, self.reason = path, reason


class VariantsFileError(DescriptionError):
    """The file of a robot's variants cannot be read, or not hold what is to be written."""

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(f"The variants in {path} cannot be used: {reason}.")
        self.path, self.reason = path, reason


class PosesFileError(DescriptionError):
    """The file of a robot's named poses cannot be read, or not hold what is to be written."""

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(f"The poses in {path} cannot be used: {reason}.")
        self.path, self.reason = path, reason


class RobotError(StudioError):
    """A URDF does not describe a robot."""


class MeshError(RobotError):
    """A mesh file cannot be shown."""

    def __init__(self, uri: str, reason: str) -> None:
        super().__init__(f"{uri}: {reason}")
        self.uri, self.reason = uri, reason


class SceneError(StudioError):
    """The 3D view cannot be served."""


class WireError(StudioError):
    """What came from ROS, or should go to it, is not as ROS 2 wants it."""


class WireSettingsError(WireError):
    """What the options or the environment say of the wire cannot be; the text says what to set."""


class NoRouterError(WireError):
    """No Zenoh router answers where one was looked for."""

    def __init__(self, endpoints: tuple[str, ...], reason: str) -> None:
        self.endpoints = endpoints
        self.reason = reason
        places = ", ".join(endpoints) or "the configured address"
        super().__init__(
            f"No Zenoh router answers at {places}: start one there (studio router, or "
            "ros2 run rmw_zenoh_cpp rmw_zenohd), or name another with --connect."
        )


class RosNameError(WireError):
    """A name, namespace, type name or key breaks a rule of ROS 2."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(f'"{name[:200]}" cannot be used in ROS 2: {reason}.')
        self.name, self.reason = name, reason


class TokenError(WireError):
    """A liveliness token, or the QoS in it, is none of rmw_zenoh's."""

    def __init__(self, token: str, reason: str) -> None:
        super().__init__(f"The liveliness token {token[:200]} was not understood: {reason}.")
        self.token, self.reason = token, reason


class AttachmentError(WireError):
    """A sample or call came without the number, time and sender that rmw_zenoh attaches."""

    def __init__(self, reason: str) -> None:
        super().__init__(f"A sample has no attachment that can be read: {reason}.")
        self.reason = reason


class InterfaceError(WireError):
    """A message, service or action type cannot be used."""


class InterfaceTextError(InterfaceError):
    """A .msg, .srv or .action text breaks a rule; `line` is 1-based, None for the text whole."""

    def __init__(self, name: str, line: int | None, reason: str) -> None:
        super().__init__(f"{name if line is None else f'{name}:{line}'}: {reason}.")
        self.name, self.line, self.reason = name, line, reason


class UnknownTypeError(InterfaceError):
    """No type of that name is known, or one that it is made of is not."""

    def __init__(self, name: str, reason: str | None = None) -> None:
        why = reason or "no known package defines it: open its package or give --interfaces"
        super().__init__(f'The type "{name[:200]}" cannot be used: {why}.')
        self.name, self.reason = name, reason


class MessageValueError(WireError):
    """A value does not fit the field of a message."""

    def __init__(self, field: str, reason: str) -> None:
        super().__init__(f"{field}: {reason}.")
        self.field, self.reason = field, reason


class CdrError(WireError):
    """Bytes from the wire are no message of the type."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(f"The bytes are no {name}: {reason}.")
        self.name, self.reason = name, reason


class WorkerError(StudioError):
    """A worker process did not answer."""


class WorkerTimeoutError(WorkerError):
    """A worker did not answer in time and was ended."""

    def __init__(self, worker: str, timeout_s: float) -> None:
        super().__init__(
            f"The {worker} worker gave no answer within {timeout_s:g} s and was restarted."
        )
        self.worker, self.timeout_s = worker, timeout_s


class WorkerDiedError(WorkerError):
    """A worker ended in the middle of a request."""

    def __init__(self, worker: str, exit_code: int | None) -> None:
        super().__init__(f"The {worker} worker ended (exit code {exit_code}) and was restarted.")
        self.worker, self.exit_code = worker, exit_code


class AccessError(StudioError):
    """Somebody asked for what is not theirs."""


class NotAllowedError(AccessError):
    """The role may not do this."""

    def __init__(self, role: str, command: str) -> None:
        super().__init__(f"A {role} may not {command.replace('_', ' ')}: ask the presenter.")
        self.role, self.command = role, command


class CommandError(StudioError):
    """A command of the browser is malformed or names what does not exist."""


class UnknownDocumentError(CommandError):
    """No open document has that id."""

    def __init__(self, document: str) -> None:
        super().__init__(f'No document "{document}" is open: open its file again.')
        self.document = document


class SupersededError(CommandError):
    """A question waited, and newer ones took its place."""

    def __init__(self) -> None:
        super().__init__("Newer questions came before this one was answered: ask again.")

"""Errors of descriptions, robots and the view of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.errors.root import StudioError

if TYPE_CHECKING:
    from studio.problems import Problem


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

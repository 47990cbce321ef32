"""A xacro file that is open in this process: its robot, and the texts that make it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from studio.description.editing.sources import Sources
from studio.description.session import open_session
from studio.description.urdf import urdf_text
from studio.description.values import (
    ArgumentsRequest,
    EditRequest,
    Expansion,
    Failure,
    OpenRequest,
    ReadPolicy,
)
from studio.errors import ExpansionError
from studio.packages.manifest import FILE_NAME, package_name
from studio.packages.roots import ServedRoots, package_folder_of

if TYPE_CHECKING:
    from collections.abc import Mapping
    from os import PathLike

    from studio.description.session import Answer, Request
    from studio.description.values import Part, Site
    from studio.problems import Problem


class XacroFile:
    """A file that was evaluated, and is evaluated again as far as each change needs it.

    When a change leaves no robot, ExpansionError has the reason; the change stays, and `urdf`,
    `parts` and `sites` are those before it. A file of unknown origin is better evaluated by a
    `DescriptionWorker`, whose process has bounded memory.

    Args:
        path: The file.
        arguments: Values of its `xacro:arg` elements; the others have their defaults.
        policy: What may be read; by default the package that the file lies in, or else its folder.

    Raises:
        ExpansionError: There is no robot; `problem` has the place.
    """

    def __init__(
        self,
        path: str | PathLike[str],
        arguments: Mapping[str, str] | None = None,
        policy: ReadPolicy | None = None,
    ) -> None:
        entry = Path(path).resolve()
        policy = policy or _policy_of(entry)
        roots = ServedRoots(map(Path, policy.roots))
        self._sources = Sources(roots.read, roots.resolve, roots.may_write, arguments)
        self._parts: dict[str, Part] = {}
        self._site_order: tuple[str, ...] = ()
        request = OpenRequest(str(entry), self._sources.arguments, policy, {})
        session, answer = open_session(request)
        self._last = self._taken(answer)
        assert session is not None  # it is None with a failure only
        self._session = session

    @property
    def urdf(self) -> str:
        """The text of the expanded robot."""
        return urdf_text(self.parts, self._last.root_attributes)

    @property
    def parts(self) -> tuple[Part, ...]:
        """The top-level elements of the robot in their order: links, joints, and the rest."""
        return tuple(self._parts.values())

    @property
    def sites(self) -> tuple[Site, ...]:
        """The texts that can be edited, in the order of the files; each with its widget."""
        return tuple(self._sources.spans.site(one) for one in self._site_order)

    @property
    def warnings(self) -> tuple[Problem, ...]:
        """Warnings of the last run that gave a robot."""
        return self._last.warnings

    @property
    def arguments(self) -> dict[str, str]:
        """The arguments that were passed; a copy."""
        return self._sources.arguments

    @property
    def unsaved_files(self) -> tuple[str, ...]:
        """Files whose text differs from the disk's."""
        return self._sources.unsaved_files

    def edit(self, site_id: str, text: str) -> Expansion:
        """Write another text at a site, in memory, and evaluate what depends on it.

        Returns:
            What changed of parts and sites.

        Raises:
            EditError: There is no such site, or its place cannot hold the text.
            ExpansionError: The texts give no robot any more.
        """
        return self._run(EditRequest((self._sources.edit_site(site_id, text),)))

    def set_argument(self, name: str, value: str | None) -> Expansion:
        """Pass an argument, or take it back with None, and evaluate what depends on it.

        Raises:
            ExpansionError: The file gives no robot with it.
        """
        self._sources.set_argument(name, value)
        return self._run(ArgumentsRequest(self._sources.arguments))

    def save(self) -> tuple[str, ...]:
        """Write the edited files, all or none of them.

        Returns:
            The files that were written.

        Raises:
            SaveConflictError: A file on disk is no longer the one that was read.
            NotSavedError: A file cannot be written.
        """
        return self._sources.save()

    def _run(self, request: Request) -> Expansion:
        self._last = self._taken(self._session.answer(request))
        return self._last

    def _taken(self, answer: Answer) -> Expansion:
        if isinstance(answer, Failure):
            raise ExpansionError(answer.problem)
        if answer.is_recovered:
            raise ExpansionError(answer.warnings[0])
        self._parts.update((part.key, part) for part in answer.changed_parts)
        if answer.part_order is not None:
            self._parts = {key: self._parts[key] for key in answer.part_order}
        self._sources.adopt(answer, self._sources.spans.version)
        if answer.site_order is not None:
            self._site_order = answer.site_order
        return answer


def _policy_of(entry: Path) -> ReadPolicy:
    package = package_folder_of(entry.parent)
    if package is None:
        return ReadPolicy((str(entry.parent),), {}, {})
    roots = ServedRoots([package])
    name = package_name(roots.read(package / FILE_NAME))
    return ReadPolicy((str(package),), {name: (str(package),)} if name else {}, {})

"""The undo list of a document as it is used: to any step, and no step for what was refused."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.editing.undo import Change
from studio.errors import CommandError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.documents.document import Document
    from studio.protocol.saving import UndoTo


class HistoryDesk:
    """Goes through the steps, and makes those that are arguments."""

    def __init__(self, document: Document) -> None:
        self._document = document

    async def go_to(self, command: UndoTo) -> None:
        """Undo or redo until that many steps are done.

        Raises:
            CommandError: The list is another one by now.
        """
        sources = self._document.sources
        count = len(sources.undo_labels) + len(sources.redo_labels)
        if command.of != count or command.position > count:
            raise CommandError("The undo list changed meanwhile: choose the step again.")
        await self._document.follow(sources.undo_to(command.position))

    async def pass_arguments(self, values: Mapping[str, str | None]) -> None:
        """Pass or take back arguments as one step; with arguments that break it, none is made.

        Raises:
            CommandError: The robot cannot be made with them; it is as before.
        """
        document, sources = self._document, self._document.sources
        before, was_failed = sources.kept(), document.failed
        label = "Arguments" if len(values) > 1 else next(iter(values))
        sources.set_arguments(values, label)
        await document.follow(Change(label, arguments=sources.arguments))
        if was_failed or not document.failed:
            return
        sentence = document.failure
        if given_up := sources.give_up(before):
            await document.follow(given_up)
            raise CommandError(f"{sentence} The arguments are as they were.")

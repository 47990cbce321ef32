"""Opening a link: its robot with its edits, and the moment of its bag."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from studio.documents.links import Moment, bag_places, found_again, place_edits, read_link
from studio.errors import CommandError, StudioError

if TYPE_CHECKING:
    from studio.documents.document import Document
    from studio.documents.links import SharedMoment, SharedRobot
    from studio.packages.roots import ServedRoots
    from studio.protocol.documents import LinkLook


class Opens(Protocol):
    """The engine."""

    documents: dict[str, Document]
    served: ServedRoots

    @property
    def bags_folder(self) -> Path:
        """Where topics are recorded."""
        ...

    def document(self, name: str) -> Document:
        """Return the open document of that id."""
        ...

    async def open_served(self, name: str, arguments: dict[str, str]) -> str:
        """Open a path, if it may be opened; returns the id of the document."""
        ...

    async def show_bag(self, bag: str, name: str = "") -> str:
        """Show a bag, if it may be opened; returns the id of the document."""
        ...


def moment_of(document: Document) -> Moment | None:
    """Return what a document shows of a bag; None: it shows none."""
    shown = document.time.shown
    if shown is None or shown.mode != "bag":
        return None
    own = document.own_bag == shown.path
    return Moment(Path(shown.path), shown.title, shown.zero_ns, document.time.at_ns, own)


async def open_link(engine: Opens, text: str) -> tuple[str, tuple[str, ...], LinkLook]:
    """Open the file of a link as usual, then make its edits and show its moment.

    Returns:
        The id of its document, what was left out, a sentence each, and how a page shows it.

    Raises:
        StudioError: It is no link, or its robot is not here.
    """
    shared = read_link(text)
    moment, troubles = shared.moment, list[str]()
    if moment is not None and moment.own:
        document = await _open_moment(engine, moment)
    else:
        document = await _open_robot(engine, shared)
        if moment is not None:
            try:
                await _open_moment(engine, moment, document.id)
            except StudioError as error:
                troubles.append(str(error))
    edits, left_out = place_edits(document.sources, document.location, shared.files)
    if edits:
        await document.edits.run(edits)
    return document.id, (*left_out, *troubles), shared.look


async def _open_robot(engine: Opens, shared: SharedRobot) -> Document:
    locations = [one.location for one in engine.documents.values()]
    path = found_again(shared.entry, engine.served, locations)
    return engine.document(await engine.open_served(str(path), shared.arguments))


async def _open_moment(engine: Opens, moment: SharedMoment, document: str = "") -> Document:
    """Show the bag in a document, or as one of its own, and go to the moment.

    Raises:
        StudioError: It is not here, or may not be opened, or cannot be read.
    """
    locations = [one.location for one in engine.documents.values()]
    why: StudioError | None = None
    for path in bag_places(moment.bag, engine.bags_folder, locations):
        try:
            name = await engine.show_bag(str(path), document)
        except StudioError as error:
            why = why or error
            continue
        shown = engine.document(name)
        await shown.time.go_to(moment.at_ns)
        return shown
    name = Path(moment.bag.path).name
    raise CommandError(f"The link shows a moment of {name}, which cannot be opened here: {why}")

"""Opening a link: its robot with its edits, and the moment of its bag."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from studio.documents.links import bag_places, found_again, place_edits, read_link
from studio.errors import CommandError, StudioError
from studio.protocol.documents import LinkOpened, OpenPath
from studio.protocol.playback import OpenBag, SeekTime

if TYPE_CHECKING:
    from studio.documents.document import Document
    from studio.documents.links import SharedMoment, SharedRobot
    from studio.packages.roots import ServedRoots
    from studio.protocol.documents import Opened, OpenLink


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

    async def open_served(self, command: OpenPath) -> Opened:
        """Open a path, if it may be opened."""
        ...

    async def open_bag(self, command: OpenBag) -> Opened:
        """Show a bag, if it may be opened."""
        ...


async def open_link(engine: Opens, command: OpenLink) -> LinkOpened:
    """Open the file of a link as usual, then make its edits and show its moment.

    Raises:
        StudioError: It is no link, or its robot is not here.
    """
    shared = read_link(command.link)
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
    left_out = (*left_out, *troubles)
    return LinkOpened(
        request=command.request, document=document.id, left_out=left_out, look=shared.look
    )


async def _open_robot(engine: Opens, shared: SharedRobot) -> Document:
    locations = [one.location for one in engine.documents.values()]
    path = found_again(shared.entry, engine.served, locations)
    opening = OpenPath(path=str(path), arguments=shared.arguments)
    return engine.document((await engine.open_served(opening)).document)


async def _open_moment(engine: Opens, moment: SharedMoment, document: str = "") -> Document:
    """Show the bag in a document, or as one of its own, and go to the moment.

    Raises:
        StudioError: It is not here, or may not be opened, or cannot be read.
    """
    locations = [one.location for one in engine.documents.values()]
    why: StudioError | None = None
    for path in bag_places(moment.bag, engine.bags_folder, locations):
        try:
            found = await engine.open_bag(OpenBag(document=document, path=str(path)))
        except StudioError as error:
            why = why or error
            continue
        shown = engine.document(found.document)
        await shown.time.seek(SeekTime(at_s=(moment.at_ns - shown.time.zero_ns) / 1e9))
        return shown
    name = Path(moment.bag.path).name
    raise CommandError(f"The link shows a moment of {name}, which cannot be opened here: {why}")

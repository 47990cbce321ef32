"""What the Doctor sees of an open document: its robot, its displays and its problems."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.live.doctor.seen import SeenDisplay, SeenDocument

if TYPE_CHECKING:
    from studio.documents.document import Document
    from studio.protocol.displays import DisplayStates


def seen_document(document: Document) -> SeenDocument:
    """Return the document's robot, displays and problems as they are now."""
    states = document.live.states
    by_id = {one.id: one for one in states.states} if states else {}
    expansion = document.last_run.expansion
    return SeenDocument(
        id=document.id,
        title=document.title,
        links=frozenset(document.model.kinematics.link_names) if expansion else frozenset(),
        root=document.model.robot.root if expansion else "",
        fixed_frame=states.fixed_frame.frame if states else "",
        fixed_trouble=_trouble_of(states),
        displays=tuple(
            SeenDisplay(one.id, one.name, by_id.get(one.id)) for one in document.live.kept.displays
        ),
        problems=document.findings.all(),
    )


def _trouble_of(states: DisplayStates | None) -> str:
    """Return why nothing, or not the robot, can be drawn in the fixed frame."""
    if states is None:
        return ""
    fixed = states.fixed_frame
    return fixed.sentence if fixed.level == "error" else states.fixed_frame_trouble

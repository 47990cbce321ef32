"""From a parsed command to the document's method that carries it out."""

from __future__ import annotations

from inspect import isawaitable
from typing import TYPE_CHECKING, Any, Final, TypeAlias, TypeVar

from studio import protocol as m
from studio.protocol import live as v
from studio.protocol import poses as p
from studio.protocol import rewriting as r
from studio.protocol import wire as w
from studio.protocol.listeners import tell
from studio.protocol.message import CommandMessage

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    from studio.documents.document import Document
    from studio.protocol.listeners import Listener

AnyCommand = TypeVar("AnyCommand", bound=CommandMessage)
Answer: TypeAlias = "m.Event | None"
"""What the asker alone is told, if anything, before it is told that all is done."""
Work: TypeAlias = "Callable[[Document, AnyCommand, Listener], Answer | Awaitable[Answer]]"


def _row(kind: type[AnyCommand], work: Work[AnyCommand]) -> tuple[type[CommandMessage], Work[Any]]:
    """A row of the table; here the two are seen to fit."""
    return kind, work


_EDITS: Final = (
    _row(m.EditSite, lambda d, c, _: d.edit_site(c.site, c.text, c.gesture)),
    _row(m.ResetSite, lambda d, c, _: d.reset_site(c.site)),
    _row(m.ApplyFix, lambda d, c, _: d.mending.apply(c.code, c.sentence, c.label)),
    _row(m.MendAll, lambda d, _, __: d.mending.apply_all()),
    _row(m.EditText, lambda d, c, _: d.edit_text(c)),
    _row(r.Rename, lambda d, c, who: d.rewriting.rename(c, who)),
    _row(r.ReplaceTexts, lambda d, c, who: d.rewriting.replace(c, who)),
    _row(m.SetArgument, lambda d, c, _: d.history.pass_arguments({c.name: c.value})),
    _row(m.SetArguments, lambda d, c, _: d.history.pass_arguments(c.values)),
    _row(m.Undo, lambda d, _, __: d.undo()),
    _row(m.Redo, lambda d, _, __: d.redo()),
    _row(m.UndoTo, lambda d, c, _: d.history.go_to(c)),
)
_FILES: Final = (
    _row(m.GetText, lambda d, c, who: d.texts.answer(c, who.role)),
    _row(m.GetCollisions, lambda d, c, _: d.disk.answer(c)),
    _row(m.ResolveCollisions, lambda d, c, _: d.saving.resolve(c)),
    _row(m.GetChanges, lambda d, c, _: d.saving.changes(c)),
    _row(m.Save, lambda d, c, _: d.save(c.files)),
    _row(m.SaveCopy, lambda d, c, _: d.saving.save_copy(c)),
    _row(m.DiscardRestored, lambda d, _, __: d.drafts.discard()),
    _row(m.Reload, lambda d, _, __: d.saving.reload()),
    _row(m.ChoosePackage, lambda d, c, _: d.choose_package(c.name, c.folder)),
)
_VIEW: Final = (
    _row(m.SetJoints, lambda d, c, _: d.motion.set(c.positions)),
    _row(m.ZeroJoints, lambda d, _, __: d.motion.zero()),
    _row(m.RandomizeJoints, lambda d, _, __: d.motion.randomize()),
    _row(m.AnimateJoints, lambda d, c, _: d.motion.animate(running=c.running)),
    _row(m.SetDisplay, lambda d, c, _: d.set_display(c.display, c.name, value=c.value)),
)
_QUESTIONS: Final = (
    _row(m.GetUrdf, lambda d, c, _: d.expanded.urdf(c)),
    _row(m.GetUrdfChanges, lambda d, c, _: d.expanded.changes(c)),
    _row(m.GetOrigin, lambda d, c, who: d.origins.origin(c, who)),
    _row(m.GetEffects, lambda d, c, who: d.origins.effects(c, who)),
    _row(m.GetFrames, lambda d, c, _: d.inspection.frames(c)),
    _row(m.GetMasses, lambda d, c, _: d.inspection.masses(c)),
    _row(m.GetOutline, lambda d, c, who: d.language.outline(c, who)),
    _row(m.LookUp, lambda d, c, who: d.language.look_up(c, who)),
    _row(m.GetReferences, lambda d, c, who: d.language.references(c, who)),
    _row(r.GetRenaming, lambda d, c, who: d.rewriting.renaming(c, who)),
    _row(r.FindTexts, lambda d, c, who: d.rewriting.find(c, who)),
    _row(m.Complete, lambda d, c, who: d.language.complete(c, who)),
)
_VARIANTS: Final = (
    _row(m.SaveVariant, lambda d, c, _: d.variants.save(c)),
    _row(m.UpdateVariant, lambda d, c, _: d.variants.save(c)),
    _row(m.ApplyVariant, lambda d, c, _: d.variants.apply(c)),
    _row(m.RenameVariant, lambda d, c, _: d.variants.rename(c)),
    _row(m.DeleteVariant, lambda d, c, _: d.variants.delete(c.name)),
    _row(m.CompareVariants, lambda d, c, _: d.variants.compare(c.sides)),
)
_POSES: Final = (
    _row(p.ApplyPose, lambda d, c, _: d.poses.apply(c)),
    _row(p.SavePose, lambda d, c, _: d.poses.save(c)),
    _row(p.RenamePose, lambda d, c, _: d.poses.rename(c)),
    _row(p.DeletePose, lambda d, c, _: d.poses.delete(c)),
)
_WIRE: Final = (
    _row(w.SetJointSource, lambda d, c, _: d.feed.choose(c.source)),
    _row(w.PublishRobot, lambda d, c, _: d.feed.publish_robot(running=c.running)),
    _row(w.PublishJoints, lambda d, c, _: d.feed.publish_joints(running=c.running)),
)
_LIVE: Final = (
    _row(v.AddDisplay, lambda d, c, _: d.live.add(c)),
    _row(v.RemoveDisplay, lambda d, c, _: d.live.remove(c)),
    _row(v.DuplicateDisplay, lambda d, c, _: d.live.duplicate(c)),
    _row(v.ArrangeDisplay, lambda d, c, _: d.live.arrange(c)),
    _row(v.SwitchDisplays, lambda d, c, _: d.live.switch(c)),
    _row(v.SetDisplayTopic, lambda d, c, _: d.live.set_topic(c)),
    _row(v.SetDisplayProperty, lambda d, c, _: d.live.set_property(c)),
    _row(v.SetFixedFrame, lambda d, c, _: d.live.fix(c)),
    _row(v.GetDisplayKinds, lambda d, c, _: d.live.kinds(c)),
    _row(v.GetTopics, lambda d, c, _: d.live.topics(c)),
    _row(v.GetTf, lambda d, c, _: d.live.tf(c)),
    _row(v.FollowFrame, lambda d, c, who: d.live.follow(c, who)),
)
WORK: Final = dict((*_EDITS, *_FILES, *_VIEW, *_QUESTIONS, *_VARIANTS, *_POSES, *_WIRE, *_LIVE))
"""What each command of a document does; those that are not here are the engine's own."""


async def carry_out(document: Document, command: m.Command, listener: Listener) -> None:
    """Carry out one command of a document; returns when it is done.

    Raises:
        StudioError: It cannot be done; the document is as before.
    """
    work = WORK.get(type(command))
    if work is None:
        raise TypeError(f"{command.type} is the engine's own command")
    answer = work(document, command, listener)
    if isawaitable(answer):
        answer = await answer
    if answer is not None:
        tell(listener, answer)

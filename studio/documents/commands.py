"""The commands of one open document: who may send each, and what it does."""

from __future__ import annotations

from typing import Final

from studio.documents.document import Document
from studio.protocol.commands import Commands, Scope
from studio.protocol.connection import PublishJoints, PublishRobot, SetJointSource
from studio.protocol.displays import (
    AddDisplay,
    ArrangeDisplay,
    DuplicateDisplay,
    FollowFrame,
    GetDisplayKinds,
    GetTf,
    GetTopics,
    RemoveDisplay,
    SetDisplayProperty,
    SetDisplayTopic,
    SetFixedFrame,
    SwitchDisplays,
)
from studio.protocol.documents import ChoosePackage, SetArgument, SetArguments
from studio.protocol.edits import ApplyFix, EditSite, MendAll, Redo, ResetSite, Undo
from studio.protocol.language import Complete, GetOutline, GetReferences, LookUp
from studio.protocol.origins import GetEffects, GetOrigin
from studio.protocol.robot import (
    AnimateJoints,
    ApplyPose,
    DeletePose,
    GetFrames,
    GetMasses,
    RandomizeJoints,
    RenamePose,
    SavePose,
    SetDisplay,
    SetJoints,
    ZeroJoints,
)
from studio.protocol.saving import (
    DiscardRestored,
    GetChanges,
    GetCollisions,
    Reload,
    ResolveCollisions,
    Save,
    SaveCopy,
    UndoTo,
)
from studio.protocol.texts import (
    EditText,
    FindTexts,
    GetRenaming,
    GetText,
    GetUrdf,
    GetUrdfChanges,
    Rename,
    ReplaceTexts,
)
from studio.protocol.variants import (
    ApplyVariant,
    CompareVariants,
    DeleteVariant,
    RenameVariant,
    SaveVariant,
    UpdateVariant,
)

COMMANDS: Final = Commands[Document](Scope.DOCUMENT)
COMMANDS.presenter(EditSite, lambda d, c, _: d.edits.edit_site(c.site, c.text, c.gesture))
COMMANDS.presenter(ResetSite, lambda d, c, _: d.edits.reset_site(c.site))
COMMANDS.presenter(ApplyFix, lambda d, c, _: d.fixes.apply(c.code, c.sentence, c.label))
COMMANDS.presenter(MendAll, lambda d, _, __: d.fixes.apply_all())
COMMANDS.presenter(EditText, lambda d, c, _: d.texts.edit(c))
COMMANDS.presenter(Rename, lambda d, c, who: d.rewriting.rename(c, who))
COMMANDS.presenter(ReplaceTexts, lambda d, c, who: d.rewriting.replace(c, who))
COMMANDS.presenter(SetArgument, lambda d, c, _: d.edits.pass_arguments({c.name: c.value}))
COMMANDS.presenter(SetArguments, lambda d, c, _: d.edits.pass_arguments(c.values))
COMMANDS.presenter(Undo, lambda d, _, __: d.edits.undo())
COMMANDS.presenter(Redo, lambda d, _, __: d.edits.redo())
COMMANDS.presenter(UndoTo, lambda d, c, _: d.edits.undo_to(c))
COMMANDS.viewer(GetText, lambda d, c, who: d.texts.answer(c, who.role))
COMMANDS.presenter(GetCollisions, lambda d, c, _: d.disk.collisions(c))
COMMANDS.presenter(ResolveCollisions, lambda d, c, _: d.disk.resolve(c))
COMMANDS.presenter(GetChanges, lambda d, c, _: d.saving.changes(c))
COMMANDS.presenter(Save, lambda d, c, _: d.saving.save(c.files))
COMMANDS.presenter(SaveCopy, lambda d, c, _: d.saving.save_copy(c))
COMMANDS.presenter(DiscardRestored, lambda d, _, __: d.drafts.discard())
COMMANDS.presenter(Reload, lambda d, _, __: d.disk.reload())
COMMANDS.presenter(ChoosePackage, lambda d, c, _: d.choose_package(c.name, c.folder))
COMMANDS.presenter(SetJoints, lambda d, c, _: d.motion.set(c.positions))
COMMANDS.presenter(ZeroJoints, lambda d, _, __: d.motion.zero())
COMMANDS.presenter(RandomizeJoints, lambda d, _, __: d.motion.randomize())
COMMANDS.presenter(AnimateJoints, lambda d, c, _: d.motion.animate(running=c.running))
COMMANDS.presenter(SetDisplay, lambda d, c, _: d.set_display(c.display, c.name, value=c.value))
COMMANDS.viewer(GetUrdf, lambda d, c, _: d.urdf.answer(c))
COMMANDS.viewer(GetUrdfChanges, lambda d, c, _: d.urdf.changes(c))
COMMANDS.viewer(GetOrigin, lambda d, c, who: d.origins.origin(c, who))
COMMANDS.viewer(GetEffects, lambda d, c, who: d.origins.effects(c, who))
COMMANDS.viewer(GetFrames, lambda d, c, _: d.inspection.frames(c))
COMMANDS.viewer(GetMasses, lambda d, c, _: d.inspection.masses(c))
COMMANDS.viewer(GetOutline, lambda d, c, who: d.language.outline(c, who))
COMMANDS.viewer(LookUp, lambda d, c, who: d.language.look_up(c, who))
COMMANDS.viewer(GetReferences, lambda d, c, who: d.language.references(c, who))
COMMANDS.presenter(GetRenaming, lambda d, c, who: d.rewriting.renaming(c, who))
COMMANDS.viewer(FindTexts, lambda d, c, who: d.rewriting.find(c, who))
COMMANDS.presenter(Complete, lambda d, c, who: d.language.complete(c, who))
COMMANDS.presenter(SaveVariant, lambda d, c, _: d.variants.save(c))
COMMANDS.presenter(UpdateVariant, lambda d, c, _: d.variants.save(c))
COMMANDS.presenter(ApplyVariant, lambda d, c, _: d.variants.apply(c))
COMMANDS.presenter(RenameVariant, lambda d, c, _: d.variants.rename(c))
COMMANDS.presenter(DeleteVariant, lambda d, c, _: d.variants.delete(c.name))
COMMANDS.presenter(CompareVariants, lambda d, c, _: d.variants.compare(c.sides))
COMMANDS.presenter(ApplyPose, lambda d, c, _: d.poses.apply(c))
COMMANDS.presenter(SavePose, lambda d, c, _: d.poses.save(c))
COMMANDS.presenter(RenamePose, lambda d, c, _: d.poses.rename(c))
COMMANDS.presenter(DeletePose, lambda d, c, _: d.poses.delete(c))
COMMANDS.presenter(SetJointSource, lambda d, c, _: d.feed.choose(c.source), scope=Scope.ROS)
COMMANDS.presenter(
    PublishRobot,
    lambda d, c, _: d.feed.publish_robot(running=c.running),
    scope=Scope.ROS,
)
COMMANDS.presenter(
    PublishJoints,
    lambda d, c, _: d.feed.publish_joints(running=c.running),
    scope=Scope.ROS,
)
COMMANDS.presenter(AddDisplay, lambda d, c, _: d.live.add(c))
COMMANDS.presenter(RemoveDisplay, lambda d, c, _: d.live.remove(c))
COMMANDS.presenter(DuplicateDisplay, lambda d, c, _: d.live.duplicate(c))
COMMANDS.presenter(ArrangeDisplay, lambda d, c, _: d.live.arrange(c))
COMMANDS.presenter(SwitchDisplays, lambda d, c, _: d.live.switch(c))
COMMANDS.presenter(SetDisplayTopic, lambda d, c, _: d.live.set_topic(c))
COMMANDS.presenter(SetDisplayProperty, lambda d, c, _: d.live.set_property(c))
COMMANDS.presenter(SetFixedFrame, lambda d, c, _: d.live.fix(c))
COMMANDS.viewer(GetDisplayKinds, lambda d, c, _: d.live.kinds(c))
COMMANDS.viewer(GetTopics, lambda d, c, _: d.live.topics(c))
COMMANDS.viewer(GetTf, lambda d, c, _: d.live.tf(c))
COMMANDS.viewer(FollowFrame, lambda d, c, who: d.live.follow(c, who))

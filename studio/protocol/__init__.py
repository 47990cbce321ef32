"""The closed unions of commands (browser to studio) and events (studio to browser).

One set of models for the websocket parser, OpenAPI and `types/wire.d.ts`. A command carries
`request`, which its `done` or `refused` repeats, and `document`, the id of the open document it
is for.
A file holds what is said about one subject, both ways.
"""

from __future__ import annotations

from typing import Annotated, TypeAlias

from pydantic import Field, TypeAdapter

from studio.protocol.bridge import BridgeCommand, BridgeEvent
from studio.protocol.documents import (
    ChoosePackage,
    CloseDocument,
    DocumentEntry,
    Documents,
    DocumentState,
    Done,
    Folder,
    FolderEntry,
    Gone,
    Hello,
    ListFolder,
    Opened,
    OpenPath,
    Progress,
    Refused,
    Watch,
)
from studio.protocol.edits import (
    Built,
    EditSite,
    History,
    Problems,
    Redo,
    ResetSite,
    Sites,
    SiteView,
    Undo,
)
from studio.protocol.expanded import GetUrdfChanges, UrdfChanges
from studio.protocol.files import (
    Collisions,
    CollisionView,
    DiskMerged,
    GetCollisions,
    Reload,
    ResolveCollisions,
    Save,
    Saved,
)
from studio.protocol.inspection import (
    Frames,
    GetFrames,
    GetMasses,
    LinkMassView,
    Masses,
    VolumeView,
)
from studio.protocol.keeping import (
    DiscardRestored,
    ForgetWork,
    GetChanges,
    KeepingCommand,
    KeepingEvent,
    SaveCopy,
    UndoTo,
)
from studio.protocol.language import (
    Complete,
    CompletionsAnswer,
    GetOutline,
    GetReferences,
    LookUp,
    MeaningAnswer,
    OutlineAnswer,
    ReferencesAnswer,
)
from studio.protocol.launching import (
    Arguments,
    ArgumentView,
    GetArguments,
    SetArgument,
    SetArguments,
)
from studio.protocol.live import LiveCommand, LiveEvent
from studio.protocol.mending import ApplyFix, MendAll
from studio.protocol.opening import (
    ExampleEntry,
    Examples,
    ForgetRecent,
    LibraryCommand,
    ListExamples,
    ListPlaces,
    ListRecent,
    NewRobot,
    NewUntitled,
    OpenExample,
    OpenRecent,
    Places,
    Recent,
    RecentEntry,
    SaveAs,
)
from studio.protocol.origins import Effects, GetEffects, GetOrigin, Origin, PartEffect
from studio.protocol.poses import PoseCommand, Poses
from studio.protocol.rewriting import RewritingCommand, RewritingEvent
from studio.protocol.robot import (
    AnimateJoints,
    Displays,
    JointPositions,
    JointView,
    LinkView,
    RandomizeJoints,
    RobotState,
    SetDisplay,
    SetJoints,
    ZeroJoints,
)
from studio.protocol.sharing import GetLink, Link, LinkOpened, OpenLink
from studio.protocol.texts import EditText, GetText, GetUrdf, Text, TextChange, TextsChanged, Urdf
from studio.protocol.variants import (
    ApplyVariant,
    CompareVariants,
    Comparison,
    DeleteVariant,
    DifferenceView,
    InputDifference,
    RenameVariant,
    SaveVariant,
    Side,
    UpdateVariant,
    VariantApplied,
    VariantCommand,
    VariantEvent,
    Variants,
    VariantSaved,
    VariantText,
    VariantView,
)
from studio.protocol.wire import WireCommand, WireEvent

Command: TypeAlias = Annotated[
    Watch
    | OpenPath
    | CloseDocument
    | ListFolder
    | EditSite
    | ResetSite
    | ApplyFix
    | MendAll
    | SetArgument
    | Undo
    | Redo
    | KeepingCommand
    | Save
    | Reload
    | GetCollisions
    | ResolveCollisions
    | GetArguments
    | SetArguments
    | GetLink
    | OpenLink
    | SetJoints
    | ZeroJoints
    | RandomizeJoints
    | AnimateJoints
    | SetDisplay
    | ChoosePackage
    | GetUrdf
    | GetUrdfChanges
    | PoseCommand
    | RewritingCommand
    | WireCommand
    | LiveCommand
    | GetText
    | GetOrigin
    | GetEffects
    | GetFrames
    | GetMasses
    | EditText
    | GetOutline
    | LookUp
    | GetReferences
    | Complete
    | VariantCommand
    | BridgeCommand
    | ListRecent
    | OpenRecent
    | ForgetRecent
    | ListExamples
    | OpenExample
    | ListPlaces
    | NewRobot
    | NewUntitled
    | SaveAs,
    Field(discriminator="type"),
]
COMMANDS: TypeAdapter[Command] = TypeAdapter(Command)

Event: TypeAlias = Annotated[
    Hello
    | Done
    | Refused
    | Documents
    | DocumentState
    | RobotState
    | JointPositions
    | Sites
    | Problems
    | History
    | Displays
    | Progress
    | Built
    | Folder
    | Opened
    | Urdf
    | UrdfChanges
    | Poses
    | RewritingEvent
    | WireEvent
    | LiveEvent
    | Text
    | TextsChanged
    | OutlineAnswer
    | MeaningAnswer
    | ReferencesAnswer
    | CompletionsAnswer
    | DiskMerged
    | Collisions
    | Arguments
    | Link
    | LinkOpened
    | Saved
    | KeepingEvent
    | Origin
    | Effects
    | Frames
    | Masses
    | VariantEvent
    | BridgeEvent
    | Recent
    | Examples
    | Places
    | Gone,
    Field(discriminator="type"),
]
EVENTS: TypeAdapter[Event] = TypeAdapter(Event)

__all__ = [
    "COMMANDS",
    "EVENTS",
    "AnimateJoints",
    "ApplyFix",
    "ApplyVariant",
    "ArgumentView",
    "Arguments",
    "BridgeCommand",
    "BridgeEvent",
    "Built",
    "ChoosePackage",
    "CloseDocument",
    "CollisionView",
    "Collisions",
    "Command",
    "CompareVariants",
    "Comparison",
    "Complete",
    "CompletionsAnswer",
    "DeleteVariant",
    "DifferenceView",
    "DiscardRestored",
    "DiskMerged",
    "Displays",
    "DocumentEntry",
    "DocumentState",
    "Documents",
    "Done",
    "EditSite",
    "EditText",
    "Effects",
    "Event",
    "ExampleEntry",
    "Examples",
    "Folder",
    "FolderEntry",
    "ForgetRecent",
    "ForgetWork",
    "Frames",
    "GetArguments",
    "GetChanges",
    "GetCollisions",
    "GetEffects",
    "GetFrames",
    "GetLink",
    "GetMasses",
    "GetOrigin",
    "GetOutline",
    "GetReferences",
    "GetText",
    "GetUrdf",
    "GetUrdfChanges",
    "Gone",
    "Hello",
    "History",
    "InputDifference",
    "JointPositions",
    "JointView",
    "LibraryCommand",
    "Link",
    "LinkMassView",
    "LinkOpened",
    "LinkView",
    "ListExamples",
    "ListFolder",
    "ListPlaces",
    "ListRecent",
    "LookUp",
    "Masses",
    "MeaningAnswer",
    "MendAll",
    "NewRobot",
    "NewUntitled",
    "OpenExample",
    "OpenLink",
    "OpenPath",
    "OpenRecent",
    "Opened",
    "Origin",
    "OutlineAnswer",
    "PartEffect",
    "Places",
    "Problems",
    "Progress",
    "RandomizeJoints",
    "Recent",
    "RecentEntry",
    "Redo",
    "ReferencesAnswer",
    "Refused",
    "Reload",
    "RenameVariant",
    "ResetSite",
    "ResolveCollisions",
    "RobotState",
    "Save",
    "SaveAs",
    "SaveCopy",
    "SaveVariant",
    "Saved",
    "SetArgument",
    "SetArguments",
    "SetDisplay",
    "SetJoints",
    "Side",
    "SiteView",
    "Sites",
    "Text",
    "TextChange",
    "TextsChanged",
    "Undo",
    "UndoTo",
    "UpdateVariant",
    "Urdf",
    "UrdfChanges",
    "VariantApplied",
    "VariantSaved",
    "VariantText",
    "VariantView",
    "Variants",
    "VolumeView",
    "Watch",
    "ZeroJoints",
]

"""Every error the studio raises, in one tree.

StudioError
    SettingsError
        PortTakenError
        DataFolderError
        UnsafeKeyError
    PackageError
        PackageNotFoundError
        OutsideRootsError
        UnreadableFileError
        UnsafeArchiveError
        ExportError
        NotMadeError
        NotRunnableError
        UploadError
    ProgramError
        ProgramNotFoundError
        CompiledProgramError
        EntryPointError
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
    LessonError
    BagError
        BagNotReadableError
        DamagedPartError
        BagNotWrittenError
        RecordingError
    LaunchError
        LaunchFileError
        TooManyActionsError
        LaunchNotFoundError
        SubstitutionFailure
    RobotError
        MeshError
    SceneError
    WireError
        WireSettingsError
        NoRouterError
        RouterGoneError
        ForeignEndpointError
        NotAdmittedError
        RouterNotStartedError
        RosNameError
            TopicNameError
            NodeNameError
            NamespaceError
        TokenError
        AttachmentError
        InterfaceError
            InterfaceTextError
            UnknownTypeError
            InterfaceClassError
            FieldPathError
        MessageValueError
            OtherMessageError
        CdrError
        ParameterError
            ParameterNotDeclaredError
            ParameterAlreadyDeclaredError
            ParameterImmutableError
            ParameterUninitializedError
            InvalidParameterTypeError
            InvalidParameterValueError
            ParameterFileError
        CallError
            NotServedError
            ServedOtherwiseError
            NoAnswerError
            DroppedError
            ServiceServerGoneError
            ActionServerGoneError
            CallRefusedError
            ForeignAnswerError
        GoalStateError
        TransitionError
        TypeDescriptionError
        NodeError
            NotJoinedError
            AlreadyJoinedError
            DestroyedError
            RosArgumentError
            OtherTypeError
            QosOverrideError
            UnsupportedEventTypeError
            ExternalShutdownException
            NodeNameNonExistentError
            RclError
            MessageCallbackError
            NotCallableError
            ExecutorTimeoutError
            WouldFailError
    WorkerError
        WorkerTimeoutError
        WorkerDiedError
    FrameError
        UnknownFrameError
        UnconnectedFramesError
        ExtrapolationError
        TransformError
    DisplayError
        DisplayMessageError
        DisplayPropertyError
        RvizConfigError
    ViewError
    ToolError
    AccessError
        NotAllowedError
        NotInControlError
        NotJoiningError
        UnknownLaneError
        TicketError
    RelayError
        RelayKeyError
        RelayRefusedError
        RelayLineError
        OriginAwayError
    CommandError
        UnknownDocumentError
        SupersededError

Each keeps its data, and its text is one sentence: what is wrong, where, and what to do.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from studio.problems import Problem


class StudioError(Exception):
    """Root of the tree; each error is explained in one sentence."""


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


class UnsafeKeyError(SettingsError):
    """Others may know the key that proves who may present, or gave it."""

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(
            f"The file {path} {reason}, and who knows it can open this studio: delete it, or "
            "choose another --data-dir."
        )
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


class NotRunnableError(PackageError):
    """A file may not be run, planned, or edited as a program."""

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(f"{path} is not run: {reason}.")
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


class ProgramError(StudioError):
    """What was to be started cannot be."""


class ProgramNotFoundError(ProgramError):
    """No package, or no executable, of that name."""

    def __init__(self, package: str, executable: str, reason: str) -> None:
        super().__init__(reason)
        self.package, self.executable, self.reason = package, executable, reason


class CompiledProgramError(ProgramError):
    """An executable is compiled from a source that is not Python, and was not built."""

    def __init__(self, package: str, executable: str, source: str) -> None:
        super().__init__(
            f"{package} {executable} is compiled from {source}, and no build of it was found: "
            f"the studio runs Python only, build it with colcon build --packages-select {package} "
            "where ROS is installed, and source install/setup.bash."
        )
        self.package, self.executable, self.source = package, executable, source


class EntryPointError(ProgramError):
    """The files of a package do not start what they should; `problem` has the place and mend."""

    def __init__(self, problem: Problem) -> None:
        fix = problem.fix
        mend = f" [{fix.label}: studio pkg check --fix does it]" if fix else ""
        place = problem.place
        where = f"{place.file}:{place.line}: " if place else ""
        super().__init__(f"{where}{problem.sentence}{mend}")
        self.problem = problem


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


class LessonError(StudioError):
    """A lesson, or a check in it, is not written as lessons are."""


class BagError(StudioError):
    """A recording cannot be read, or cannot be written."""


class BagNotReadableError(BagError):
    """What lies at a path is no bag, or cannot be read; `path` is as it was asked for."""

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(f"{path} cannot be read: {reason}")
        self.path, self.reason = path, reason


class DamagedPartError(BagError):
    """A part of a bag is damaged, as a sentence about `it`; readers leave it out and say so."""

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason


class BagNotWrittenError(BagError):
    """A bag cannot be written, or no further; `path` is that of its folder."""

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(f"{path} cannot be written: {reason}")
        self.path, self.reason = path, reason


class RecordingError(BagError):
    """What was asked of a recording cannot be done: there is no such moment, topic or number."""


class LaunchError(StudioError):
    """A launch file cannot be found, read, planned or run."""


class LaunchFileError(LaunchError):
    """A launch file has a fault; `line` is 1-based, 0 where it is not known."""

    def __init__(self, path: str, line: int, reason: str) -> None:
        place = f"{path}:{line}" if line else path
        super().__init__(f"{place}: {reason}")
        self.path, self.line, self.reason = path, line, reason


class TooManyActionsError(LaunchError):
    """A launch file does more than is done for one."""


class LaunchNotFoundError(LaunchError):
    """No launch file has that name; the sentence says what there is instead."""


class SubstitutionFailure(LaunchError):  # noqa: N818 - ROS's name
    """A substitution has no value; ROS's name, for launch files catch it."""


class RobotError(StudioError):
    """A URDF does not describe a robot."""


class MeshError(RobotError):
    """A mesh file cannot be shown."""

    def __init__(self, uri: str, reason: str) -> None:
        super().__init__(f"{uri}: {reason}")
        self.uri, self.reason = uri, reason


class SceneError(StudioError):
    """The 3D view cannot be served."""


class DisplayError(StudioError):
    """A display cannot do what is asked of it."""


class DisplayMessageError(DisplayError):
    """A message that was read makes no sense, or cannot be drawn."""

    def __init__(self, kind: str, reason: str) -> None:
        super().__init__(f"The {kind} cannot be drawn: {reason}.")
        self.kind, self.reason = kind, reason


class DisplayPropertyError(DisplayError):
    """A property of a display is not there, or does not take a value."""

    def __init__(self, name: str, takes: str, value: object) -> None:
        given = "" if value is None else f", not {str(value)[:60]!r}"
        super().__init__(f"{name} {takes}{given}.")
        self.name, self.takes, self.value = name, takes, value


class RvizConfigError(DisplayError):
    """An `.rviz` file cannot be taken as it is; `line` is 1-based, None where it is not known."""

    def __init__(self, reason: str, line: int | None = None, name: str = "") -> None:
        what = f'"{name[:200]}"' if name else "This file"
        place = "" if line is None else f" (line {line})"
        super().__init__(
            f"{what} is no config file that can be opened{place}: {reason}. What is shown stays as "
            "it is."
        )
        self.reason, self.line, self.name = reason, line, name


class ViewError(StudioError):
    """There is no such kind of view, or it has no such property."""


class ToolError(StudioError):
    """There is no such tool, or it cannot do what is asked of it."""


class FrameError(StudioError):
    """A frame is unknown, or nothing connects it with another."""


class UnknownFrameError(FrameError):
    """The frame is in no transform received."""

    def __init__(self, frame: str) -> None:
        super().__init__(f'No transform tells of the frame "{frame}": is its publisher running?')
        self.frame = frame


class UnconnectedFramesError(FrameError):
    """Two frames are in different trees, or in one that runs in a circle."""

    def __init__(self, target: str, source: str, nearest: str | None = None) -> None:
        """`nearest` is the frame that everything around `source` hangs on, if one is known."""
        missing = "publish the one that is missing between their trees"
        if nearest == source:
            missing = f'publish the pose of "{source}", which no transform has'
        instead = "" if nearest is None else f', or look from "{nearest}" instead'
        super().__init__(
            f'No chain of transforms connects "{source}" with "{target}": {missing}{instead}.'
        )
        self.target, self.source, self.nearest = target, source, nearest


class ExtrapolationError(FrameError):
    """A transform of the chain is not known at the requested time.

    `frame` is the child of that transform; times are in ns of the clock of its stamps.
    """

    def __init__(self, frame: str, asked_ns: int, oldest_ns: int, newest_ns: int) -> None:
        if asked_ns > newest_ns:
            which, by_ns = "newer than the newest", asked_ns - newest_ns
            mend = "wait for its publisher, or compare its clock with that of the message"
        else:
            which, by_ns = "older than the oldest", oldest_ns - asked_ns
            mend = "send the message sooner, or compare its clock with that of the publisher"
        super().__init__(
            f"The stamp is {by_ns / 1e9:.3f} s {which} transform that is known of "
            f'"{frame}": {mend}.'
        )
        self.frame, self.asked_ns = frame, asked_ns
        self.oldest_ns, self.newest_ns = oldest_ns, newest_ns

    @property
    def may_come(self) -> bool:
        """Whether waiting can help: the stamp is newer than what is known."""
        return self.asked_ns > self.newest_ns


class TransformError(FrameError):
    """A received transform is not valid."""

    def __init__(self, parent: str, child: str, reason: str) -> None:
        super().__init__(f'The transform from "{parent}" to "{child}" was left out: {reason}.')
        self.parent, self.child, self.reason = parent, child, reason


class WireError(StudioError):
    """Data from or for ROS is not as ROS 2 wants it."""


class WireSettingsError(WireError):
    """Options or environment are not valid for the connection; the text says what to set."""


class NoRouterError(WireError):
    """No Zenoh router answers at the given address."""

    def __init__(self, endpoints: tuple[str, ...], reason: str) -> None:
        self.endpoints = endpoints
        self.reason = reason
        places = ", ".join(endpoints) or "the configured address"
        super().__init__(
            f"No Zenoh router answers at {places}: start one there (studio router, or "
            "ros2 run rmw_zenoh_cpp rmw_zenohd), or name another with --connect."
        )


class RouterGoneError(WireError):
    """The router that was joined is away, so that nothing goes out and nothing comes."""

    def __init__(self, endpoint: str) -> None:
        super().__init__(
            f"The router at {endpoint} is gone, so no node can be reached: start it "
            "there again (studio router), then try once more."
        )
        self.endpoint = endpoint


class ForeignEndpointError(WireError):
    """The endpoint of a router is held by a program that does not speak Zenoh."""

    def __init__(self, endpoint: str) -> None:
        super().__init__(
            f"Something that is no Zenoh router holds {endpoint}: end it, or name another place "
            "with --router or --connect."
        )
        self.endpoint = endpoint


class NotAdmittedError(WireError):
    """A router answers, and hangs up when a session is opened."""

    def __init__(self, endpoint: str) -> None:
        super().__init__(
            f"The router at {endpoint} lets nobody in without the name, password or certificate "
            "that it knows: set them in ZENOH_CONFIG_OVERRIDE or ZENOH_SESSION_CONFIG_URI."
        )
        self.endpoint = endpoint


class RouterNotStartedError(WireError):
    """A router cannot listen at its address; `held`: another program does."""

    def __init__(self, endpoint: str, reason: str, *, held: bool) -> None:
        why = "another program listens there" if held else reason.rstrip(".! ")
        super().__init__(
            f"No router was started at {endpoint} ({why}): name another place with --listen "
            "or --router."
        )
        self.endpoint, self.reason, self.held = endpoint, reason, held


class RosNameError(WireError):
    """A name, namespace, type name or key breaks a rule of ROS 2."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(f'"{name[:200]}" cannot be used in ROS 2: {reason}.')
        self.name, self.reason = name, reason


class TopicNameError(RosNameError, ValueError):
    """No topic, service or action may be named so."""


class NodeNameError(RosNameError):
    """No node may be named so."""


class NamespaceError(RosNameError):
    """No namespace may be named so."""


class TokenError(WireError):
    """A liveliness token, or the QoS in it, is none of rmw_zenoh's."""

    def __init__(self, token: str, reason: str) -> None:
        super().__init__(f"The liveliness token {token[:200]} was not understood: {reason}.")
        self.token, self.reason = token, reason


class AttachmentError(WireError):
    """A sample or call came without the number, time and sender that rmw_zenoh attaches."""

    def __init__(self, reason: str) -> None:
        super().__init__(f"Its attachment cannot be read: {reason}.")
        self.reason = reason


class InterfaceError(WireError):
    """A message, service or action type cannot be used."""


class InterfaceTextError(InterfaceError):
    """A .msg, .srv or .action text breaks a rule; `line` is 1-based, None for the text whole."""

    def __init__(self, name: str, line: int | None, reason: str) -> None:
        super().__init__(f"{name if line is None else f'{name}:{line}'}: {reason}.")
        self.name, self.line, self.reason = name, line, reason

    def at(self, path: str) -> InterfaceTextError:
        """Return the same error with the file of the text."""
        return InterfaceTextError(path, self.line, self.reason)


class UnknownTypeError(InterfaceError):
    """No type of that name is known, or one that it is made of is not."""

    def __init__(self, name: str, reason: str | None = None) -> None:
        why = reason or "no known package defines it: open its package or give --interfaces"
        super().__init__(f'The type "{name[:200]}" cannot be used: {why}.')
        self.name, self.reason = name, reason


class InterfaceClassError(InterfaceError, AttributeError):
    """A class of messages or a service is needed, and something else was given."""

    def __init__(self, given: str, word: str) -> None:
        super().__init__(
            f"{given} is no {word} of ROS 2: import one, such as "
            + (
                "from std_msgs.msg import String"
                if word == "message"
                else "from std_srvs.srv import Trigger"
            )
            + ", from the package that defines it."
        )
        self.given, self.word = given, word


class FieldPathError(InterfaceError):
    """Messages have no number at a path."""

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(f'There is no number at "{path[:200]}": {reason}.')
        self.path, self.reason = path, reason


class MessageValueError(WireError, AssertionError):
    """A value does not fit the field of a message."""

    def __init__(self, field: str, reason: str) -> None:
        super().__init__(f"{field}: {reason}.")
        self.field, self.reason = field, reason


class OtherMessageError(MessageValueError, TypeError):
    """A message of one type is needed, and another, or no message, was given."""


class CdrError(WireError):
    """Bytes from the wire are no message of the type."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(f"The bytes are no {name}: {reason}.")
        self.name, self.reason = name, reason


class ParameterError(WireError):
    """A parameter cannot be declared, read or set."""


class ParameterNotDeclaredError(ParameterError):
    """A node has no parameter of that name."""

    def __init__(self, name: str) -> None:
        super().__init__(f'The parameter "{name[:200]}" is not declared: declare it first.')
        self.name = name


class ParameterAlreadyDeclaredError(ParameterError):
    """A node has a parameter of that name already."""

    def __init__(self, name: str) -> None:
        super().__init__(
            f'The parameter "{name[:200]}" is declared already: declare it once, then read or set '
            "it (every node declares use_sim_time by itself)."
        )
        self.name = name


class ParameterImmutableError(ParameterError):
    """A parameter that may only be read was to be changed or taken away."""

    def __init__(self, name: str) -> None:
        super().__init__(
            f'The parameter "{name[:200]}" is read-only: give its value when the node is started.'
        )
        self.name = name


class ParameterUninitializedError(ParameterError):
    """A parameter was declared by its type alone, and has no value yet."""

    def __init__(self, name: str) -> None:
        super().__init__(
            f'The parameter "{name[:200]}" has no value yet: give it one when the node is started, '
            "or set it."
        )
        self.name = name


class InvalidParameterTypeError(ParameterError):
    """A parameter was given a value of another type than its own, or of none that ROS 2 has."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(f'The parameter "{name[:200]}" does not take that type: {reason}.')
        self.name, self.reason = name, reason


class InvalidParameterValueError(ParameterError):
    """A parameter was given a value outside its range, or one that its node refuses."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(f'The parameter "{name[:200]}" was refused: {reason}')
        self.name, self.reason = name, reason


class ParameterFileError(ParameterError):
    """A file of parameters cannot be read."""

    def __init__(self, where: str, reason: str) -> None:
        super().__init__(f"{where}: {reason}.")
        self.where, self.reason = where, reason


class CallError(WireError):
    """A node was asked and gave no answer."""


class NotServedError(CallError):
    """No node serves what was asked for, or none does any more."""

    def __init__(self, what: str, name: str) -> None:
        super().__init__(f"No node serves the {what} {name}: start its node, or look at its name.")
        self.what, self.name = what, name


class ServedOtherwiseError(CallError):
    """There is a server, with another type or another form of it."""

    def __init__(self, what: str, name: str, asked: str, types: tuple[str, ...]) -> None:
        served = " and ".join(types)
        how = (
            f"with another form of {asked}: give the studio the text that its node has"
            if asked in types
            else f"as {served}, not as {asked}: call it with that type"
        )
        super().__init__(f"The {what} {name} is served {how}.")
        self.what, self.name, self.asked, self.types = what, name, asked, types


class NoAnswerError(CallError):
    """A server is there and was silent for too long."""

    def __init__(self, what: str, name: str, timeout_s: float) -> None:
        super().__init__(
            f"The {what} {name} gave no answer within {timeout_s:g} s: "
            "its node may be busy, or hang; give it more time, or start it again."
        )
        self.what, self.name, self.timeout_s = what, name, timeout_s


class DroppedError(CallError):
    """A server is there and let a request fall, as servers do when too many come at once."""

    def __init__(self, what: str, name: str) -> None:
        super().__init__(
            f"The {what} {name} dropped a request: too many came at once, or its node just ended; "
            "ask again, fewer at a time."
        )
        self.what, self.name = what, name


class ServiceServerGoneError(CallError):
    """The server of a service ended during a call of ours."""

    def __init__(self, name: str) -> None:
        super().__init__(
            f"The node that served the service {name} ended before it answered: "
            "start it and call again."
        )
        self.name = name


class ActionServerGoneError(CallError):
    """The server of an action ended during a goal of ours."""

    def __init__(self, name: str) -> None:
        super().__init__(
            f"The node that served the action {name} ended before the goal did: "
            "start it and send the goal again."
        )
        self.name = name


class GoalStateError(WireError):
    """A goal was to change to a state that does not follow the one it is in."""

    def __init__(self, status: str, event: str) -> None:
        super().__init__(f"A goal that is {status} cannot {event}: do it once, in its order.")
        self.status, self.event = status, event


class TransitionError(WireError):
    """A managed node was to take a transition that does not begin in its state."""

    def __init__(self, transition: str, state: str, known: list[str]) -> None:
        others = ", ".join(known) or "none"
        super().__init__(
            f'A node that is {state} takes no transition "{transition[:80]}": it takes {others}.'
        )
        self.transition, self.state = transition, state


class TypeDescriptionError(WireError):
    """A node's description of a type cannot be trusted or used."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(f'The description of "{name[:200]}" was not taken: {reason}.')
        self.name, self.reason = name, reason


class NodeError(WireError):
    """A node, or what carries out its work, cannot do what was asked."""


class NotJoinedError(NodeError):
    """A node was made, or work was asked for, before `init` or after `shutdown`."""

    def __init__(self) -> None:
        super().__init__(
            "The wire is not joined: call init() before a node is made, and shutdown() last."
        )


class AlreadyJoinedError(NodeError, RuntimeError):
    """`init` was called twice."""

    def __init__(self) -> None:
        super().__init__("The wire is joined already: call init() once, or shutdown() before.")


class DestroyedError(NodeError):
    """Something was used after it was destroyed."""

    def __init__(self, what: str) -> None:
        super().__init__(f"The {what} was destroyed: make it again, or keep it longer.")
        self.what = what


class RosArgumentError(NodeError):
    """An argument after `--ros-args` cannot be read."""

    def __init__(self, argument: str, reason: str) -> None:
        super().__init__(f'The argument "{argument[:200]}" is not understood: {reason}.')
        self.argument, self.reason = argument, reason


class OtherTypeError(NodeError):
    """A class of messages is not what its name means on the wire that it is used on."""

    def __init__(self, name: str, distro: str) -> None:
        super().__init__(
            f'The class "{name}" is not that of {distro}, or its text changed since it was '
            "imported: set ROS_DISTRO before it is imported, or import it anew."
        )
        self.name, self.distro = name, distro


class QosOverrideError(NodeError):
    """A parameter that overrides the QoS of a topic cannot be taken."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(f'The parameter "{name[:200]}" overrides no QoS: {reason}.')
        self.name, self.reason = name, reason


class UnsupportedEventTypeError(NodeError):
    """A callback was given for an event that does not exist on Zenoh."""

    def __init__(self, event: str) -> None:
        super().__init__(
            f"The event {event} does not exist on Zenoh, nor in rmw_zenoh: leave its callback out."
        )
        self.event = event


class ExternalShutdownException(NodeError):  # noqa: N818  # the name that rclpy's users catch
    """The process received a signal to end while a node was spinning."""

    def __init__(self) -> None:
        super().__init__("The node was told to end.")


class NodeNameNonExistentError(NodeError):
    """No node of that name is in the graph."""

    def __init__(self, path: str) -> None:
        super().__init__(f"No node {path} is there: ros2 node list names those that are.")
        self.path = path


class RclError(NodeError, RuntimeError):
    """What rcl refuses, in its words, for a program that knows them."""


class MessageCallbackError(NodeError, RuntimeError):
    """What a subscription was to call does not take a message."""

    def __init__(self, topic: str, given: str, *, is_callable: bool) -> None:
        mend = (
            "write def callback(self, msg)"
            if is_callable
            else "give the function itself, self.callback and not self.callback()"
        )
        super().__init__(
            f"The callback for {topic} must take a message, or a message and its MessageInfo, and "
            f"{given} does not: {mend}."
        )
        self.topic, self.given = topic, given


class NotCallableError(NodeError, TypeError):
    """What was to be called back is no function."""

    def __init__(self, given: str) -> None:
        super().__init__(
            f"A callback must be callable, and {given} is not: give the function itself, "
            "self.callback and not self.callback()."
        )
        self.given = given


class ExecutorTimeoutError(NodeError):
    """No work was ready in time."""

    def __init__(self) -> None:
        super().__init__("No work of the nodes was ready in time: wait for it again.")


class WouldFailError(NodeError):
    """A user's program does what works here and would fail in ROS 2."""

    def __init__(self, place: str, reason: str, mend: str) -> None:
        where = f"{place}: " if place else ""
        super().__init__(f"would fail in ROS 2: {where}{reason}: {mend}.")
        self.place, self.reason, self.mend = place, reason, mend


class CallRefusedError(CallError):
    """A server answered a request with an error, which nodes on rmw_zenoh never do."""

    def __init__(self, name: str, reply: str) -> None:
        super().__init__(f'The service {name} refused the request: "{reply}".')
        self.name, self.reply = name, reply


class ForeignAnswerError(CallError):
    """A server answered a request as no node on rmw_zenoh does."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(
            f"An answer of the service {name} was dropped: {reason}; its node is to repeat number "
            "and sender of the request."
        )
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
    """A person asked for something that is not allowed."""


class NotAllowedError(AccessError):
    """The role may not do this."""

    def __init__(self, role: str, command: str) -> None:
        super().__init__(f"A {role} may not {command.replace('_', ' ')}: ask the presenter.")
        self.role, self.command = role, command


class NotInControlError(AccessError):
    """Somebody else has control of the robot and of the ROS system."""

    def __init__(self, role: str, command: str) -> None:
        what = command.replace("_", " ")
        way = "take it back" if role == "presenter" else "ask for it"
        super().__init__(f"Only who has control may {what}: {way} first.")
        self.role, self.command = role, command


class NotJoiningError(AccessError):
    """A person cannot join the class; `why` names the reason for the page."""

    def __init__(self, why: str, sentence: str) -> None:
        super().__init__(sentence)
        self.why = why


class UnknownLaneError(AccessError):
    """A bulk lane was asked for with a key of no open data lane."""

    def __init__(self) -> None:
        super().__init__("No open data lane has this key: ask for one on your data lane.")


class TicketError(AccessError):
    """A ticket proves nobody: it was made up, changed, or is of another room."""

    def __init__(self, reason: str) -> None:
        super().__init__(f"This ticket is not valid: {reason} Join the class again.")
        self.reason = reason


class RelayError(StudioError):
    """A relay, or the line between it and the studio, does not work."""


class RelayKeyError(RelayError):
    """What was given is no relay's line, `tls/HOST:PORT#KEY`."""

    def __init__(self, reason: str) -> None:
        super().__init__(
            f"This is no line of a relay ({reason}): copy the one that `studio relay` prints, as "
            "tls/HOST:7448#KEY."
        )
        self.reason = reason


class RelayRefusedError(RelayError):
    """The relay answers, and does not take this studio."""

    def __init__(self, endpoint: str, reason: str) -> None:
        super().__init__(f"The relay at {endpoint} does not serve this studio: {reason}")
        self.endpoint, self.reason = endpoint, reason


class RelayLineError(RelayError):
    """What came on the line between studio and relay is not to be believed."""

    def __init__(self, reason: str) -> None:
        super().__init__(f"The line between studio and relay is ended: {reason}")
        self.reason = reason


class OriginAwayError(RelayError):
    """The studio that owns a room is not there, so that nothing can be changed in it."""

    def __init__(self) -> None:
        super().__init__(
            "The studio is away: what you see is the last that came. Try again once it is back."
        )


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

"""Messages about the packages of the opened folders: what they hold, and what is added to them.

Fields are those of `studio.packages.inspection`, where they are explained.
"""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import BeforeValidator, Field, StringConstraints

from studio.problems import Problem
from studio.protocol.message import Command, Event, Message

PathText: TypeAlias = Annotated[str, BeforeValidator(str)]
"""An absolute path."""
_PresenceName: TypeAlias = Literal["workspace", "installed", "ros", "system", "unknown"]
NodeTemplateName: TypeAlias = Literal[
    "publisher",
    "subscriber",
    "service_server",
    "service_client",
    "action_server",
    "action_client",
    "parameters",
    "timer",
    "empty",
]
_Short: TypeAlias = Annotated[str, StringConstraints(max_length=200)]
_Text: TypeAlias = Annotated[str, StringConstraints(max_length=2000)]


class GetWorkspaces(Command):
    """Ask what the opened folders hold; `changed` of the subject `workspaces` says when anew."""

    type: Literal["get_workspaces"] = "get_workspaces"


class DependencyView(Message):
    """One package that is depended on, with every tag that says so."""

    name: str
    kinds: tuple[str, ...]
    presence: _PresenceName
    line: int


class ExecutableView(Message):
    """What `ros2 run` starts by a name; `file` null: no file of the package has its code."""

    name: str
    place: str
    language: str
    file: PathText | None
    declared_in: PathText
    line: int
    fault: str


class InterfaceFileView(Message):
    """A message, service or action that the package defines."""

    name: str
    kind: str
    file: PathText
    is_generated: bool
    fault: str
    line: int


class LaunchFileView(Message):
    """A launch file of the package."""

    file: PathText
    format: str
    is_installed: bool


class RobotFileView(Message):
    """A file that is, or might be taken for, a robot description."""

    file: PathText
    title: str
    openable: bool
    reason: str


class ParameterFileView(Message):
    """A YAML file with parameters of nodes."""

    file: PathText
    nodes: tuple[str, ...]


class PackageView(Message):
    """A package as its source shows it."""

    name: str
    folder: PathText
    path: str
    build_type: str
    version: str
    description: str
    licenses: tuple[str, ...]
    maintainers: tuple[str, ...]
    dependencies: tuple[DependencyView, ...]
    executables: tuple[ExecutableView, ...]
    interfaces: tuple[InterfaceFileView, ...]
    launch_files: tuple[LaunchFileView, ...]
    robots: tuple[RobotFileView, ...]
    rviz_configs: tuple[PathText, ...]
    parameter_files: tuple[ParameterFileView, ...]
    readme: PathText | None
    is_nested: bool
    fault: str
    is_complete: bool
    may_run: bool = False
    """Whether its launch files and nodes may be run, and its programs edited."""


class DependencyEdgeView(Message):
    """One package of the workspace needs another one."""

    package: str
    needs: str
    kinds: tuple[str, ...]


class DependencyNodeView(Message):
    """A package in the graph."""

    name: str
    presence: _PresenceName


class DependencyGraphView(Message):
    """Who needs whom."""

    nodes: tuple[DependencyNodeView, ...]
    edges: tuple[DependencyEdgeView, ...]
    cycles: tuple[tuple[str, ...], ...]


class WorkspaceView(Message):
    """All packages below a folder."""

    root: PathText
    packages: tuple[PackageView, ...]
    graph: DependencyGraphView
    left_out: tuple[str, ...]
    problems: tuple[Problem, ...] = ()
    """What is wrong in them, as it is among the document's."""


class Workspaces(Event):
    """Answer to `get_workspaces`."""

    type: Literal["workspaces"] = "workspaces"
    request: int
    run_folders: tuple[str, ...]
    """Of `--allow-run`; empty: nothing may be run."""
    workspaces: tuple[WorkspaceView, ...]
    is_reading: bool
    """Whether some are not read yet; `changed` comes when they are."""


class CreatePackage(Command):
    """Make a package, in the words of `ros2 pkg create`."""

    type: Literal["create_package"] = "create_package"
    folder: Annotated[str, StringConstraints(min_length=1, max_length=4096)]
    """The workspace folder; in one with an `src`, it is made there."""
    name: _Short
    build_type: Literal["ament_python", "ament_cmake"] = "ament_python"
    dependencies: Annotated[tuple[_Short, ...], Field(max_length=100)] = ()
    node_name: _Short = ""
    library_name: _Short = ""
    license: _Short = ""
    description: _Text = ""
    maintainer_name: _Short = ""
    maintainer_email: _Short = ""
    contents: Literal["nodes", "interfaces", "description"] = "nodes"
    """`interfaces`: prepared for messages, services and actions; `description`: around a robot."""


class AddToPackage(Command):
    """Add a message, service, action, node or launch file to a package."""

    type: Literal["add_to_package"] = "add_to_package"
    package: Annotated[str, StringConstraints(min_length=1, max_length=4096)]
    """Its folder."""
    what: Literal["message", "service", "action", "node", "launch_file"]
    name: _Short
    text: Annotated[str, StringConstraints(max_length=100_000)] = ""
    """Fields of an interface; empty: a sample."""
    template: NodeTemplateName = "empty"
    """What a node begins with."""


class MendPackage(Command):
    """Make the edit of a finding's fix; the three fields name the finding as in `workspaces`."""

    type: Literal["mend_package"] = "mend_package"
    code: str
    sentence: str
    label: str


class UndoPackageEdit(Command):
    """Take the newest edit of packages back, if nobody has changed its files since."""

    type: Literal["undo_package_edit"] = "undo_package_edit"
    edit: int


class PackageEdited(Event):
    """Answer to `create_package`, `add_to_package` and `mend_package`."""

    type: Literal["package_edited"] = "package_edited"
    request: int
    edit: int
    """For `undo_package_edit`."""
    label: str
    opened: str
    """The new file that a person wants to see first."""
    files: tuple[str, ...]
    by_hand: tuple[str, ...]
    """What was not written, with the lines to write."""

"""What the audience of a document is told: its whole state to a newcomer, every change to all."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.documents.checks.findings import Findings
from studio.documents.robot_view import RobotViews
from studio.documents.sites import SiteBook
from studio.protocol.documents import DocumentState, Progress
from studio.protocol.edits import History, Problems
from studio.protocol.listeners import Audience, Listener, tell
from studio.protocol.robot import Displays, JointPositions, RobotState

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.documents.document import Document
    from studio.problems import Problem
    from studio.protocol import Event


class Board:
    """Makes events from the document's state; says only what is news."""

    def __init__(self, document: Document) -> None:
        self.audience = Audience()
        self.book = SiteBook()
        self._document = document
        self._findings = Findings()
        self._views = RobotViews()
        self._robot_told: RobotState | None = None
        self._joints_told: JointPositions | None = None

    @property
    def found(self) -> tuple[Problem, ...]:
        """Every problem, as the audience was told them."""
        return self._findings.all()

    def attach(self, listener: Listener) -> None:
        """Tell a newcomer the whole state, then let it hear every change."""
        for event in self._snapshot():
            tell(listener, event)
        self.audience.add(listener)
        self._document.poses.doubt()

    def state(self) -> None:
        """Tell what the document is: files, arguments, evaluator, phase."""
        self.audience.tell(self._state())

    def robot(self) -> None:
        """Tell the robot's tree and where its joints stand, as far as that is news."""
        robot, joints = self._views.state(self._document.model), self._joints()
        if robot != self._robot_told:
            self._robot_told, self._joints_told = robot, None
            self.audience.tell(robot)
            self._document.poses.doubt()
        if joints != self._joints_told:
            self.audience.tell(joints)
        self._joints_told = joints

    def joints(self) -> None:
        """Tell where the joints stand, by name."""
        self.audience.tell(self._joints())

    def joint_frame(self) -> None:
        """Send the positions packed; a slow page gets the newest only."""
        model = self._document.model
        self.audience.post(model.joints.frame(model.revision), binary=True, key="joints")

    def texts(self) -> None:
        """Tell the sites that changed, the undo list and what is unsaved."""
        if news := self.book.news(self._document.sources):
            self.audience.tell(news)
        self.audience.tell(self._history())

    def displays(self) -> None:
        """Tell the shared display settings."""
        self.audience.tell(self._displays())

    def find(self, origin: str, problems: Iterable[Problem]) -> None:
        """Set what `origin` finds now, and tell when that is news."""
        if self._findings.replace(origin, problems):
            self.problems()

    def problems(self) -> None:
        """Tell all problems."""
        self.audience.tell(self._problems())

    def progress(self, task: str, done: int, total: int) -> None:
        """Tell how far long work is."""
        label = {"meshes": "Loading meshes", "expand": "Reading the description"}[task]
        self.audience.tell(
            Progress.model_validate({"task": task, "label": label, "done": done, "total": total})
        )

    def _snapshot(self) -> Iterable[Event]:
        yield self._state()
        if self._document.expansion:
            yield self._views.state(self._document.model)
            yield self._joints()
            yield self.book.everything()
        yield self._displays()
        yield self._history()
        yield self._problems()
        yield from self._document.variants.events()
        yield from self._document.poses.events()
        yield from self._document.feed.events()
        yield from self._document.live.events()
        yield from self._document.drafts.events()

    def _state(self) -> DocumentState:
        document = self._document
        expansion, location = document.expansion, document.location
        files = expansion.files if expansion else (document.path,)
        served = location.served
        return DocumentState(
            id=document.id,
            title=document.title,
            path=document.path,
            root=str(location.root),
            arguments=document.sources.arguments,
            evaluator=expansion.evaluator if expansion else "",
            fallback_reason=expansion.fallback_reason if expansion else "",
            files=files,
            packages=document.packages_used(),
            read_only=tuple(file for file in files if not served.may_write(file)),
            phase=document.phase,
        )

    def _joints(self) -> JointPositions:
        document = self._document
        return JointPositions(
            positions=document.model.joints.by_name(), animating=document.motion.swinging
        )

    def _history(self) -> History:
        sources = self._document.sources
        return History(
            undo=sources.undo_labels,
            redo=sources.redo_labels,
            unsaved_files=sources.unsaved_files,
            unsaved_count=sources.unsaved_count,
        )

    def _displays(self) -> Displays:
        return Displays(displays=self._document.scene.displays())

    def _problems(self) -> Problems:
        document = self._document
        return Problems(
            problems=self._findings.all(),
            showing_last_good=document.failed and document.expansion is not None,
        )

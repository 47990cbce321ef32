"""RobotModels: gives each RobotModel display the robot of its description."""

from __future__ import annotations

import asyncio
import logging
from typing import TYPE_CHECKING, Final

from studio.displays.robot_model import RobotModelDisplay
from studio.errors import StudioError
from studio.live.connection.received_description import receive_description
from studio.live.displays.robot_reading import stamps_of
from studio.protocol.connection import OpenFromWire

if TYPE_CHECKING:
    from collections.abc import Coroutine, Mapping

    from studio.displays.display import Display
    from studio.displays.posed_robot import PosedRobot
    from studio.displays.robot_model import DescriptionSource
    from studio.files import Stamp
    from studio.live.connection.received_description import ReadsParameters, ReceivedDescription
    from studio.live.displays.robot_reading import DescribedRobot, RobotReader
    from studio.live.topics.source import TopicSource
    from studio.robot.values import Robot

_PAUSE_S: Final = 0.5
"""Between two readings of one description: it may be published all the time."""
_ASK_AGAIN_S: Final = 2.0
"""Between two requests to a node that does not answer yet."""
_LOOK_EVERY_S: Final = 1.0
"""Between two looks whether the file of a description was saved."""
_NOT_CONNECTED: Final = "There is no connection with a ROS 2 system, where the parameter would be."

_log = logging.getLogger(__name__)


class _Model:
    """A RobotModel display and its description."""

    def __init__(self, display: RobotModelDisplay) -> None:
        self.display = display
        self.source = display.source
        self.wanted = self.done = ""
        """Texts, or the file, as it is to be read and as it was."""
        self.is_partial = False
        """Whether the description that is shown could be read in part only."""
        self.own: Robot | None = None
        """The document's robot as it was taken last."""
        self.working: asyncio.Task[None] | None = None
        self.received: ReceivedDescription | None = None
        self.asking = False
        self.ask_after_s = 0.0
        self.is_gone = False
        self.stamps: Mapping[str, Stamp | None] = {}
        """Of the files that its description was read from."""
        self.looking = False
        self.look_after_s = 0.0

    def close_description(self) -> None:
        """Receive its parameter no more."""
        received, self.received = self.received, None
        if received is not None:
            received.close()


class RobotModels:
    """Steps on the loop with the displays; slow work is done elsewhere.

    Args:
        own: The document's robot, which one may show.
        source: Where topics come from.
        reader: Reads the others; closed with this.
    """

    def __init__(self, own: PosedRobot, source: TopicSource, reader: RobotReader) -> None:
        self._own, self._source, self._reader = own, source, reader
        self._models: dict[str, _Model] = {}
        self._link: ReadsParameters | None = None
        self._tasks: set[asyncio.Task[None]] = set()

    def step(self, displays: Mapping[str, Display], link: ReadsParameters | None) -> None:
        """Read what the displays want now, and pass on what has come.

        Args:
            displays: All there are by their ids.
            link: The connection, if there is one.
        """
        models = {name: one for name, one in displays.items() if isinstance(one, RobotModelDisplay)}
        for name, model in tuple(self._models.items()):
            if models.get(name) is not model.display:
                self._forget(self._models.pop(name))
        if link is not self._link:
            self.let_go()
        self._link = link
        for name, display in models.items():
            self._step(self._models.setdefault(name, _Model(display)))

    def let_go(self) -> None:
        """Receive nothing more: the connection is about to end."""
        self._link = None
        for model in self._models.values():
            model.close_description()

    async def close(self) -> None:
        """End the worker, and all that is running."""
        for model in self._models.values():
            model.is_gone = True
        self.let_go()
        for task in tuple(self._tasks):
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        await self._reader.close()

    def _step(self, model: _Model) -> None:
        display, source = model.display, model.display.source
        if source != model.source:
            self._begin_anew(model, source)
        match source.kind:
            case "Document":
                self._show_own(model)
            case "Topic":
                self._want(model, display.description)
            case "File":
                self._want(model, source.where)
                self._look(model)
            case "Parameter":
                self._read_parameter(model)

    def _show_own(self, model: _Model) -> None:
        robot = self._own.robot
        if model.own is robot:
            return
        model.own = robot
        try:
            model.display.show(robot)
            model.display.fail("")
        except StudioError as error:
            model.display.fail(str(error))

    def _begin_anew(self, model: _Model, source: DescriptionSource) -> None:
        """Start with another source; what was received from the one before is dropped."""
        model.source, model.wanted, model.done, model.ask_after_s = source, "", "", 0.0
        model.own, model.stamps = None, {}
        model.display.fail("")
        model.close_description()

    def _want(self, model: _Model, text: str) -> None:
        """Read a text or file unless it was read; the newest counts."""
        model.wanted = text
        if text == model.done:
            model.done = text  # this very object, for it is long: no need to compare it again
        elif model.working is None:
            model.working = self._spawn(self._work(model))

    def _look(self, model: _Model) -> None:
        """Read a file again when it, or one that it includes, was saved."""
        now_s = asyncio.get_running_loop().time()
        idle = not model.looking and model.working is None
        if model.stamps and idle and now_s >= model.look_after_s:
            model.looking, model.look_after_s = True, now_s + _LOOK_EVERY_S
            self._spawn(self._look_at(model, model.stamps))

    async def _look_at(self, model: _Model, stamps: Mapping[str, Stamp | None]) -> None:
        try:
            now = await asyncio.to_thread(stamps_of, stamps)
        finally:
            model.looking = False
        if model.stamps is stamps and now != stamps:
            model.done = ""

    async def _work(self, model: _Model) -> None:
        try:
            while not model.is_gone and model.wanted != model.done:
                source, text = model.source, model.wanted
                await self._read(model, source, text)
                if source == model.source:
                    model.done = text
                await asyncio.sleep(_PAUSE_S)
        finally:
            model.working = None

    async def _read(self, model: _Model, source: DescriptionSource, text: str) -> None:
        try:
            is_file = source.kind == "File"
            read = self._reader.read_file if is_file else self._reader.read_text
            described = await read(text)
            if source == model.source and not model.is_gone:
                model.stamps = described.stamps
                model.display.fail(_shown(model, described))
        except StudioError as error:
            if source == model.source:
                model.display.fail(_kept(model.display, str(error)))

    def _read_parameter(self, model: _Model) -> None:
        """Take the parameter's answer, and ask again if there is none."""
        if model.received is not None:
            text = model.received.newest()
            self._want(model, model.wanted if text is None else text)
        elif self._link is None:
            model.display.fail(_NOT_CONNECTED)
        elif not model.asking and asyncio.get_running_loop().time() >= model.ask_after_s:
            model.asking = True
            self._spawn(self._ask(model, self._link, model.source))

    async def _ask(self, model: _Model, link: ReadsParameters, source: DescriptionSource) -> None:
        wanted = OpenFromWire(node=source.where, parameter=source.parameter)
        try:
            received = await asyncio.to_thread(receive_description, self._source, link, wanted)
        except StudioError as error:
            model.ask_after_s = asyncio.get_running_loop().time() + _ASK_AGAIN_S
            if source == model.source:
                model.display.fail(str(error))
            return
        finally:
            model.asking = False
        if source == model.source and link is self._link and not model.is_gone:
            model.received = received
            model.display.fail("")
        else:
            received.close()

    def _forget(self, model: _Model) -> None:
        model.is_gone = True
        model.close_description()

    def _spawn(self, work: Coroutine[None, None, None]) -> asyncio.Task[None]:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._ended)
        return task

    def _ended(self, task: asyncio.Task[None]) -> None:
        self._tasks.discard(task)
        if not task.cancelled() and (error := task.exception()):
            _log.error("The robot of a display could not be read.", exc_info=error)


def _shown(model: _Model, described: DescribedRobot) -> str:
    """Show a robot, and return a message about it.

    A broken description after a good one leaves the good one shown.

    Raises:
        DisplayError: It is too large to draw.
    """
    display, robot = model.display, described.robot
    fault = described.fault or ("" if robot.links else "It describes no link.")
    if fault and (not robot.links or (display.robot.links and not model.is_partial)):
        return _kept(display, fault)
    display.show(robot)
    model.is_partial = bool(fault)
    return fault and f"The description is shown as far as it can be read: {fault}"


def _kept(display: RobotModelDisplay, fault: str) -> str:
    stays = " What was there before stays." if display.robot.links else ""
    return f"The description cannot be shown: {fault}{stays}"

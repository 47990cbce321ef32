"""FramesDesk: where frames are for one document: TF of the wire, and the robot's own links."""

from __future__ import annotations

import asyncio
import threading
from typing import TYPE_CHECKING, Final, Protocol

from studio.displays.drawing import FIXED_FRAME, NO_TURN, ORIGIN
from studio.errors import CdrError, FrameError
from studio.live.displays.clock_watch import CLOCK_QOS, CLOCK_TYPE, ClockWatch
from studio.live.displays.own_frames import OwnFrames
from studio.protocol.displays import FrameView, GetTf, TfFrames, TfPose
from studio.ros.columns.transforms import TransformCodec
from studio.ros.qos import DurabilityPolicy, QoSProfile
from studio.tf.buffer import TransformBuffer
from studio.tf.transforms import Notice, plain_name

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.live.displays.ear import Hearing
    from studio.live.displays.own_frames import PosedRobot
    from studio.live.displays.placing import Pose
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.node.samples import MessageInfo, RawCallback
    from studio.tf.frames import FramesNow
    from studio.tf.report import FrameReport
    from studio.tf.transforms import TransformColumns

STILL: Final[Pose] = (NO_TURN, ORIGIN)
_TF_TYPE: Final = "tf2_msgs/msg/TFMessage"
_DYNAMIC: Final = QoSProfile(depth=100)
_STATIC: Final = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_FRAMES_SHOWN: Final = 2_000
_LOOK_EVERY_S: Final = 0.05
_FIRST_LOOKS: Final = 20
_OTHERS_S: Final = 0.2
"""After the first frames, for those of other nodes: they come some times a second."""
_NOTICES_KEPT: Final = 20
_PUBLISHERS_KEPT: Final = 1_000


class KnowsPublishers(Protocol):
    """What the desk needs of the graph."""

    def endpoint_of_gid(self, gid: bytes) -> GraphEndpoint | None:
        """Whose message it is."""
        ...

    def publishers(self, topic: str) -> Sequence[GraphEndpoint]:
        """Those of a topic; raises a RosNameError when it is none."""
        ...


class Epoch:
    """From the first message that is heard to the last: what comes later does not count."""

    def __init__(self) -> None:
        self.turn = threading.Lock()
        self.is_over = False


class FramesDesk:
    """Feeds one buffer and answers in the fixed frame.

    `/tf` is taken in on the wire's thread; all else is the loop's.
    """

    def __init__(self, robot: PosedRobot) -> None:
        self.buffer = TransformBuffer()
        self.own = OwnFrames(robot, self.buffer)
        self.chosen = ""
        """The fixed frame as chosen; empty: the root link of the robot."""
        self._turn = threading.Lock()
        """Who listens and who ends that come from different threads."""
        self._ends: list[Callable[[], None]] = []
        self._epoch = Epoch()
        self._closed = False
        self._jumped = False
        self._publishers: dict[bytes, str] = {}
        self._notices: dict[str, Notice] = {}
        self._now: FramesNow | None = None
        self._now_of: tuple[int, str] = (0, "")

    @property
    def fixed(self) -> str:
        """The frame that everything is drawn in."""
        return self.chosen or self.own.root

    def listen(self, hearing: Hearing, graph: KnowsPublishers) -> None:
        """Hear TF from now on, if it is not heard already; in a thread."""
        with self._turn:
            if self._ends or self._closed:
                return
            for topic, static in (("/tf_static", True), ("/tf", False)):
                take, qos = self._taker(graph, static=static), _STATIC if static else _DYNAMIC
                self._ends.append(hearing.hear(_TF_TYPE, topic, take, qos))
            clock = ClockWatch(self._clock_jumped).take
            self._ends.append(hearing.hear(CLOCK_TYPE, "/clock", clock, CLOCK_QOS))

    async def hear_first(self, graph: KnowsPublishers) -> None:
        """Wait for what is published of frames, so that the first list has them; not for long."""
        if not any(graph.publishers(topic) for topic in ("/tf", "/tf_static")):
            return
        before = self.buffer.changes
        for _ in range(_FIRST_LOOKS):
            await asyncio.sleep(_LOOK_EVERY_S)
            if self.buffer.changes != before:
                await asyncio.sleep(_OTHERS_S)
                return

    def look(self, graph: KnowsPublishers) -> None:
        """Take back the robot's own links from those who told of them and are gone; in a thread."""
        told = tuple(self._publishers.items())
        there = {
            one.node.path for topic in ("/tf", "/tf_static") for one in graph.publishers(topic)
        }
        gone = {name for _, name in told} - there
        if gone:
            self._publishers = {gid: name for gid, name in told if name not in gone}
            self.own.take_back_from(gone)

    def deafen(self) -> None:
        """Hear TF no more, and forget what it told; in a thread."""
        with self._turn:
            ends, self._ends = self._ends, []
            for end in ends:
                end()
            before, self._epoch = self._epoch, Epoch()
            with before.turn:  # a message that is being taken in is forgotten with the others
                before.is_over = True
                self.buffer.clear()
                self._publishers.clear()
                self._notices.clear()
                self.own.take_back()

    def close(self) -> None:
        """Hear TF no more, also if somebody is about to listen; in a thread."""
        self._closed = True
        self.deafen()

    def has_jumped(self) -> bool:
        """Whether time went back since this was asked last, as of a bag that begins anew."""
        if not self._jumped:
            return False  # what is said of it at this moment is told the next time
        self._jumped = False
        return True

    def step(self) -> None:
        """Tell of the robot's own links what nobody else tells."""
        self.own.step()

    def lookup(self, frame: str, stamp_ns: int) -> Pose:
        """The pose of a frame in the fixed frame.

        Raises:
            FrameError: There is none at that time.
        """
        fixed = self.fixed
        if frame in (FIXED_FRAME, fixed):
            return STILL
        if stamp_ns == 0 and (now := self._newest().pose_of(frame)):
            return now[:4], now[4:]
        pose = self.buffer.fixed_from(fixed, frame, stamp_ns)
        return pose.wxyz, pose.xyz

    def now(self) -> FramesNow:
        """All frames with their ages, each by the newest transforms on its way."""
        self._now_of = self.buffer.changes, self.fixed
        self._now = self.buffer.all_in(self.fixed)
        return self._now

    def _newest(self) -> FramesNow:
        """The same, as of the last change: all that is drawn in one tick stands together."""
        if self._now is None or self._now_of != (self.buffer.changes, self.fixed):
            return self.now()
        return self._now

    def robot_pose(self) -> tuple[Pose | None, str]:
        """Where the robot's root link is in the fixed frame, and why it is not known."""
        root = self.own.root
        if not root:
            return None, ""
        try:
            return self.lookup(root, 0), ""
        except FrameError as error:
            return None, str(error)

    def offered_for(self, frame: str) -> str:
        """In which frame everything may be drawn so that a part in this one has a place.

        Where nothing tells of the fixed frame it is the same for all parts; where nothing tells of
        the frame of the part it is none, which is empty, unless nobody tells of any frame at all.
        """
        now = self._newest()
        if not now.names:
            return frame
        if now.fixed not in now.rows:
            return now.root_of_most()
        return frame if plain_name(frame) in now.rows else ""

    def trouble_of(self, frame: str) -> str:
        """Why it is not known where a frame is, in a sentence; empty: it is."""
        try:
            self.lookup(frame, 0)
        except FrameError as error:
            return str(error)
        return ""

    def answer(self, asked: GetTf, fixed: str) -> TfFrames:
        """All frames, as the page lists them, and where one is in another; in any thread."""
        pose, trouble = self._pose(asked.seen_from, asked.frame)
        if asked.pose_only:
            return TfFrames(
                request=asked.request,
                fixed=fixed,
                frames=(),
                more=0,
                refused=(),
                pose=pose,
                trouble=trouble,
            )
        rows = self.buffer.report(fixed, most=_FRAMES_SHOWN)
        return TfFrames(
            request=asked.request,
            fixed=fixed,
            frames=tuple(map(_view, rows)),
            more=max(0, self.buffer.count() - len(rows)),
            refused=tuple(one.sentence for one in tuple(self._notices.values())),
            pose=pose,
            trouble=trouble,
        )

    def _pose(self, seen_from: str, frame: str) -> tuple[TfPose | None, str]:
        if not frame or not seen_from:
            return None, ""
        try:
            pose = self.buffer.fixed_from(seen_from, frame)
            chain = self.buffer.chain(seen_from, frame)
        except FrameError as error:
            return None, str(error)
        return TfPose(wxyz=pose.wxyz, xyz=pose.xyz, chain=chain), ""

    def _taker(self, graph: KnowsPublishers, *, static: bool) -> RawCallback:
        codec, epoch = TransformCodec(), self._epoch

        def take(data: bytes, info: MessageInfo) -> None:
            try:
                columns = codec.decode(data)
            except CdrError:
                return
            name = self._publisher(graph, info["publisher_gid"])
            with epoch.turn:
                if not epoch.is_over:
                    self._take(columns, name, static=static)

        return take

    def _take(self, columns: TransformColumns, publisher: str, *, static: bool) -> None:
        self.own.leave_to_others(columns.children, publisher)
        for one in self.buffer.put(columns, static=static, publisher=publisher):
            self._note(one)
            self._jumped |= one.kind == "time_jumped"

    def _clock_jumped(self, now_ns: int, before_ns: int) -> None:
        """As tf2 does: what was told of later times does not hold."""
        self.buffer.jump_back(now_ns, before_ns)
        sentence = (
            f"Time went back by {(before_ns - now_ns) / 1e9:.3f} s on /clock: what was told of "
            "later times was forgotten."
        )
        self._note(Notice("time_jumped", "", "", "", sentence, left_out=False))
        self._jumped = True

    def _publisher(self, graph: KnowsPublishers, gid: bytes) -> str:
        """The node that has a GID; one that is not known yet is looked up again."""
        if name := self._publishers.get(gid):
            return name
        endpoint = graph.endpoint_of_gid(gid)
        if endpoint is None:
            return gid.hex()
        if len(self._publishers) >= _PUBLISHERS_KEPT:
            self._publishers.clear()
        self._publishers[gid] = endpoint.node.path
        return endpoint.node.path

    def _note(self, notice: Notice) -> None:
        self._notices.pop(notice.sentence, None)
        self._notices[notice.sentence] = notice
        while len(self._notices) > _NOTICES_KEPT:
            del self._notices[next(iter(self._notices))]


def _view(row: FrameReport) -> FrameView:
    return FrameView(
        name=row.frame,
        parent=row.parent or "",
        publisher=", ".join(row.publishers),
        static=row.static,
        rate_hz=round(row.rate_hz, 1),
        age_s=None if row.age_s is None or row.static else round(row.age_s, 1),
        state=row.state,
    )

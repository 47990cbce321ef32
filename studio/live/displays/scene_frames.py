"""SceneFrames: where frames are for one document: TF, and the robot's own links."""

from __future__ import annotations

import asyncio
import threading
from typing import TYPE_CHECKING, Final

from studio.displays.drawing import NO_TURN, ORIGIN
from studio.displays.properties import FIXED_FRAME
from studio.errors import CdrError, ExtrapolationError, FrameError
from studio.live.displays.clock_watch import CLOCK, ClockWatch
from studio.live.displays.later_frames import LaterFrames
from studio.live.displays.own_frames import OwnFrames
from studio.live.topics.request import Request
from studio.protocol.displays import FixedFrameState, FrameView, GetTf, TfFrames, TfPose
from studio.ros.columns.transforms import TransformCodec
from studio.tf.buffer import TransformBuffer
from studio.tf.transforms import Notice, plain_name

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.displays.drawing import Pose
    from studio.displays.posed_robot import PosedRobot
    from studio.live.topics.source import TopicSource
    from studio.live.topics.subscription import Subscription
    from studio.ros.node.samples import RawSample
    from studio.tf.frames import FramesNow
    from studio.tf.report import FrameReport
    from studio.tf.transforms import TransformColumns

STILL: Final[Pose] = (NO_TURN, ORIGIN)
_TF_TYPE: Final = "tf2_msgs/msg/TFMessage"
_TOPICS: Final = ("/tf_static", "/tf")
_FRAMES_SHOWN: Final = 2_000
_CHECK_EVERY_S: Final = 0.05
_FIRST_CHECKS: Final = 20
_OTHERS_S: Final = 0.2
"""After the first frames, for those of other nodes: they come some times a second."""
_NOTICES_KEPT: Final = 20
_PUBLISHERS_KEPT: Final = 1_000


class SceneFrames:
    """Feeds one buffer and answers in the fixed frame.

    TF is taken in by a thread of the source; all else is the loop's.
    """

    def __init__(self, robot: PosedRobot, source: TopicSource) -> None:
        self.buffer = TransformBuffer(clock=lambda: source.now_ns)
        self.own = OwnFrames(robot, self.buffer)
        self._later = LaterFrames(self.buffer)
        self.chosen = ""
        """The fixed frame as chosen; empty: the root link of the robot."""
        self._source, self._epoch = source, source.epoch
        self._forgetting = threading.Lock()
        """Both threads may be the first to see another epoch."""
        self._subscriptions: list[Subscription] = []
        self._clock: ClockWatch | None = None
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

    def subscribe(self) -> bool:
        """Receive TF from now on; return whether it was not received before."""
        if self._subscriptions or self._closed:
            return False
        self._keep_epoch()
        for topic in _TOPICS:
            static = topic == "/tf_static"
            request = Request(topic, (_TF_TYPE,), latched=static, depth=100, as_known_here=True)
            take = self._taker(static=static)
            self._subscriptions.append(self._source.subscribe(request, take=take))
        self._clock = ClockWatch(self._clock_jumped)
        self._subscriptions.append(self._source.subscribe(CLOCK, take=self._clock.take))
        return True

    @property
    def clock_ns(self) -> int | None:
        """The newest time of /clock; None: nobody publishes it, or none came yet."""
        if self._clock is None or not self._source.publishers(CLOCK.topic):
            return None
        return self._clock.now_ns

    @property
    def recorded_ns(self) -> int | None:
        """The time of the recording that is shown; None: it is the live system."""
        return None if self._source.is_live else self._source.now_ns

    @property
    def ros_ns(self) -> int:
        """ROS time: that of /clock while it is published, else that of the topics."""
        clock_ns = self.clock_ns
        return self._source.now_ns if clock_ns is None else clock_ns

    @property
    def fixed_state(self) -> FixedFrameState:
        """Whether there is a frame of the fixed frame's name, as RViz's global status has it."""
        frame = self.fixed
        names = self._newest().names
        if frame in names or (frame and frame in self.own.links):
            return FixedFrameState(frame=frame, level="ok", sentence="")
        if not names:
            sentence = "No transforms have come yet, so no frame is known."
            return FixedFrameState(frame=frame, level="warn", sentence=sentence)
        sentence = f'There is no frame "{frame[:80]}": choose one of those that are published.'
        return FixedFrameState(frame=frame, level="error", sentence=sentence)

    async def wait_for_first(self) -> None:
        """Wait for what is published of frames, so that the first list has them; not for long."""
        if not any(self._source.publishers(topic) for topic in _TOPICS):
            return
        before = self.buffer.changes
        for _ in range(_FIRST_CHECKS):
            await asyncio.sleep(_CHECK_EVERY_S)
            if self.buffer.changes != before:
                await asyncio.sleep(_OTHERS_S)
                return

    async def wait_for_clock(self) -> None:
        """Wait for the first time on /clock where somebody publishes it; not for long."""
        for _ in range(_FIRST_CHECKS):
            if self.clock_ns is not None or not self._source.publishers(CLOCK.topic):
                return
            await asyncio.sleep(_CHECK_EVERY_S)

    def drop_gone(self) -> None:
        """Take back the robot's own links from those who published them and are gone."""
        known = tuple(self._publishers.items())
        if not known or self._source.connection != "there":  # else all seem to be gone
            return
        there = {one.node for topic in _TOPICS for one in self._source.publishers(topic)}
        gone = {name for _, name in known} - there
        if gone:
            self._publishers = {gid: name for gid, name in known if name not in gone}
            self.own.take_back_from(gone)

    def unsubscribe(self) -> None:
        """Receive TF no more, and forget what came."""
        subscriptions, self._subscriptions = self._subscriptions, []
        self._clock = None
        for one in subscriptions:
            one.close()
        self._forget()

    def close(self) -> None:
        """End the subscriptions to TF."""
        self._closed = True
        self.unsubscribe()

    def has_jumped(self) -> bool:
        """Whether time went back since this was asked last, as of a bag that begins again."""
        if not self._jumped:
            return False  # a change during the notification is found the next time
        self._jumped = False
        return True

    def step(self) -> None:
        """Set the robot's own links that nobody else publishes."""
        self._keep_epoch()
        self.own.step()

    def lookup(self, frame: str, stamp_ns: int) -> Pose:
        """Return the pose of a frame in the fixed frame.

        Raises:
            FrameError: There is none at that time.
        """
        fixed = self.fixed
        if frame in (FIXED_FRAME, fixed):
            return STILL
        if stamp_ns == 0 and (now := self._newest().pose_of(frame)):
            return now[:4], now[4:]
        try:
            pose = self.buffer.fixed_from(fixed, frame, stamp_ns)
        except ExtrapolationError as error:
            later = self._source.later_tf
            if not later or not error.may_come:
                raise
            found = self._later.pose(later, fixed, frame, stamp_ns)
            return found[:4], found[4:]
        return pose.wxyz, pose.xyz

    def now(self) -> FramesNow:
        """Return all frames and their ages, by the newest transforms."""
        self._now_of = self.buffer.changes, self.fixed
        self._now = self.buffer.all_in(self.fixed)
        return self._now

    def _newest(self) -> FramesNow:
        """Return the same, as of the last change: all that is drawn in one tick stands together."""
        if self._now is None or self._now_of != (self.buffer.changes, self.fixed):
            return self.now()
        return self._now

    def robot_pose(self) -> tuple[Pose | None, str]:
        """Return the pose of the robot's root link in the fixed frame, or why it is unknown."""
        root = self.own.root
        if not root:
            return None, ""
        try:
            return self.lookup(root, 0), ""
        except FrameError as error:
            return None, str(error)

    def offered_for(self, frame: str) -> str:
        """Return a fixed frame in which everything may be drawn, this frame's part included.

        If no transform names the fixed frame, it is the same for all parts; if none names the
        frame of the part, it is empty, unless there are no transforms at all.
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
        """Return all frames for the page, and the pose of one in another; thread-safe."""
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

    def _taker(self, *, static: bool) -> Callable[[RawSample], None]:
        codec = TransformCodec()

        def take(sample: RawSample) -> None:
            try:
                columns = codec.decode(sample.payload)
            except CdrError:
                return
            self._keep_epoch()
            self._take(columns, sample, static=static)

        return take

    def _keep_epoch(self) -> None:
        """Forget what came in another epoch."""
        if self._epoch != self._source.epoch:
            with self._forgetting:
                if self._epoch != self._source.epoch:
                    self._forget()
                    self._epoch = self._source.epoch

    def _forget(self) -> None:
        self.buffer.clear()
        self._publishers.clear()
        self._notices.clear()
        self.own.take_back()

    def _take(self, columns: TransformColumns, sample: RawSample, *, static: bool) -> None:
        publisher = self._publisher(sample.attachment.gid)
        self.own.leave_to_others(columns.children, publisher)
        at_ns = sample.received_ns
        for one in self.buffer.put(columns, static=static, publisher=publisher, received_ns=at_ns):
            self._note(one)
            self._jumped |= one.kind == "time_jumped"

    def _clock_jumped(self, now_ns: int, before_ns: int) -> None:
        """Drop transforms from the future, as tf2 does."""
        self.buffer.jump_back(now_ns, before_ns)
        sentence = (
            f"Time went back by {(before_ns - now_ns) / 1e9:.3f} s on /clock: transforms of "
            "later times were dropped."
        )
        self._note(Notice("time_jumped", "", "", "", sentence, left_out=False))
        self._jumped = True

    def _publisher(self, gid: bytes) -> str:
        """Return the name of the node that has a GID; an unknown one is looked up again."""
        if name := self._publishers.get(gid):
            return name
        name = self._source.sender(gid)
        if name is None:
            return gid.hex()
        if len(self._publishers) >= _PUBLISHERS_KEPT:
            self._publishers.clear()
        self._publishers[gid] = name
        return name

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

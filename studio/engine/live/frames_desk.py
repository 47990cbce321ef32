"""FramesDesk: where frames are for one document: TF of the wire, and the robot's own links."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.displays.drawing import FIXED_FRAME
from studio.engine.live.own_frames import OwnFrames
from studio.engine.messages.live import FrameView, GetTf, TfFrames, TfPose
from studio.errors import CdrError, FrameError
from studio.ros.fast.transforms import TransformCodec
from studio.ros.qos import DurabilityPolicy, QoSProfile
from studio.tf.buffer import TransformBuffer

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.engine.live.ear import Hearing
    from studio.engine.live.placing import Pose
    from studio.engine.model import Model
    from studio.ros.graph.graph import Graph
    from studio.ros.node.info import MessageInfo
    from studio.tf.admission import Notice
    from studio.tf.report import FrameReport

_TF_TYPE: Final = "tf2_msgs/msg/TFMessage"
_DYNAMIC: Final = QoSProfile(depth=100)
_STATIC: Final = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_FRAMES_SHOWN: Final = 2_000
_NOTICES_KEPT: Final = 20
_PUBLISHERS_KEPT: Final = 1_000


class FramesDesk:
    """Feeds one buffer and answers in the fixed frame.

    `/tf` is taken in on the wire's thread; all else is the loop's.
    """

    def __init__(self, model: Model) -> None:
        self.buffer = TransformBuffer()
        self.own = OwnFrames(model, self.buffer)
        self.chosen = ""
        """The fixed frame as chosen; empty: the root link of the robot."""
        self._ends: list[Callable[[], None]] = []
        self._publishers: dict[bytes, str] = {}
        self._notices: dict[str, Notice] = {}

    @property
    def fixed(self) -> str:
        """The frame that everything is drawn in."""
        return self.chosen or self.own.root

    @property
    def listens(self) -> bool:
        """Whether TF is heard."""
        return bool(self._ends)

    def listen(self, hearing: Hearing, graph: Graph) -> None:
        """Hear TF from now on; in a thread."""
        for topic, static in (("/tf_static", True), ("/tf", False)):
            take = self._taker(graph, static=static)
            self._ends.append(hearing.hear(_TF_TYPE, topic, take, _STATIC if static else _DYNAMIC))

    def deafen(self) -> None:
        """Hear TF no more, and forget what it told; in a thread."""
        ends, self._ends = self._ends, []
        for end in ends:
            end()
        self.buffer.clear()
        self._publishers.clear()
        self.own.take_back()

    def step(self) -> None:
        """Tell of the robot's own links what nobody else tells."""
        self.own.step()

    def lookup(self, frame: str, stamp_ns: int) -> Pose:
        """The pose of a frame in the fixed frame.

        Raises:
            FrameError: There is none at that time.
        """
        pose = self.buffer.fixed_from(
            self.fixed, self.fixed if frame == FIXED_FRAME else frame, stamp_ns
        )
        return pose.wxyz, pose.xyz

    def robot_pose(self) -> tuple[Pose | None, str]:
        """Where the robot's root link is in the fixed frame, and why it is not known."""
        root = self.own.root
        if not root:
            return None, ""
        try:
            return self.lookup(root, 0), ""
        except FrameError as error:
            return None, str(error)

    def answer(self, asked: GetTf) -> TfFrames:
        """All frames, as the page lists them, and where one is in another."""
        rows = self.buffer.report(self.fixed)
        pose, trouble = self._pose(asked.seen_from, asked.frame)
        return TfFrames(
            request=asked.request,
            fixed=self.fixed,
            frames=tuple(map(_view, rows[:_FRAMES_SHOWN])),
            more=max(0, len(rows) - _FRAMES_SHOWN),
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

    def _taker(self, graph: Graph, *, static: bool) -> Callable[[bytes, MessageInfo], None]:
        codec = TransformCodec()

        def take(data: bytes, info: MessageInfo) -> None:
            try:
                columns = codec.decode(data)
            except CdrError:
                return
            self.own.leave_to_others(frozenset(columns.children))
            name = self._publisher(graph, info["publisher_gid"])
            notices = self.buffer.put(columns, static=static, publisher=name)
            for one in notices:
                self._note(one)

        return take

    def _publisher(self, graph: Graph, gid: bytes) -> str:
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

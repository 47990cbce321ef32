"""Buffer: keeps transforms and looks them up, under tf2_ros's names, over `studio.tf`."""

from __future__ import annotations

import threading
import time as system_time
from typing import TYPE_CHECKING, Any, Final

from studio.errors import ExtrapolationError, FrameError, UnconnectedFramesError, UnknownFrameError
from studio.ros.columns.transforms import TransformCodec
from studio.ros.duration import NANOSECONDS, Duration
from studio.ros.messages import message
from studio.ros.node.clock import Time
from studio.ros.node.task import Future
from studio.ros.types.yaml_texts import write_yaml
from studio.tf.buffer import HISTORY_NS, FramePose, TransformBuffer
from studio.tf.rotations import compose, inverse
from studio.tf2.buffer_interface import BufferInterface

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.node.node import Node
    from studio.ros.types.classes import MessageValue

_CHECK_S: Final = 0.02
_NONE: Final = Duration()
_MISSING = (UnknownFrameError, UnconnectedFramesError, ExtrapolationError)


class Buffer(BufferInterface):
    """Transforms of the last seconds (ten, unless `cache_time` says otherwise); thread-safe."""

    def __init__(self, cache_time: Duration | None = None, node: Node | None = None) -> None:
        super().__init__()
        history_ns = HISTORY_NS if cache_time is None else cache_time.nanoseconds
        self._transforms = TransformBuffer(history_ns)
        self._codec = TransformCodec()
        self._lock = threading.Lock()
        self._waiting: list[tuple[Callable[[], bool], Future[Any]]] = []
        self._notices: Callable[[str], object] | None = None
        if node is not None:
            self._serve_frames(node)

    def set_transform(self, transform: MessageValue, authority: str) -> None:
        """Take up a transform that holds at its time."""
        self._put(transform, authority, static=False)

    def set_transform_static(self, transform: MessageValue, authority: str) -> None:
        """Take up a transform that holds at all times."""
        self._put(transform, authority, static=True)

    def take_message(self, data: bytes, *, static: bool) -> tuple[str, ...]:
        """Take up the bytes of a TFMessage; returns what was left out, in sentences.

        Raises:
            CdrError: They are none.
        """
        notices = self._transforms.put(self._codec.decode(data), static=static)
        self._settle()
        return tuple(notice.sentence for notice in notices)

    def clear(self) -> None:
        """Forget everything."""
        self._transforms.clear()

    def jump_back(self, now_ns: int, before_ns: int) -> None:
        """Forget what is newer than a time to which the clock went back; what is static stays."""
        self._transforms.jump_back(now_ns, before_ns)

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: Time, timeout: Duration | None = None
    ) -> Any:  # noqa: ANN401
        """Return the transform from one frame to another; time 0 is the newest common one.

        Args:
            target_frame: The frame that is seen from.
            source_frame: The frame that is seen.
            time: When.
            timeout: Wait so long for it; it comes only where another thread spins the node.

        Raises:
            FrameError: It is not known.
        """
        return self._within(timeout, lambda: self._found(target_frame, source_frame, time))

    def lookup_transform_full(  # as in tf2_ros
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration | None = None,
    ) -> Any:  # noqa: ANN401
        """Return the transform between two times, by way of a frame that stands still.

        Raises:
            FrameError: It is not known.
        """
        times = (target_time, source_time)

        def find() -> Any:  # noqa: ANN401
            return self._found_full(target_frame, source_frame, fixed_frame, times)

        return self._within(timeout, find)

    def can_transform(  # as in tf2_ros
        self,
        target_frame: str,
        source_frame: str,
        time: Time,
        timeout: Duration | None = None,
        return_debug_tuple: bool = False,  # noqa: FBT001, FBT002
    ) -> Any:  # noqa: ANN401
        """Whether the transform is known; with `return_debug_tuple`, and why not."""
        return self._can(
            lambda: self.lookup_transform(target_frame, source_frame, time, timeout),
            told=return_debug_tuple,
        )

    def can_transform_full(  # noqa: PLR0913, PLR0917  # as in tf2_ros
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration | None = None,
        return_debug_tuple: bool = False,  # noqa: FBT001, FBT002
    ) -> Any:  # noqa: ANN401
        """Whether the transform between two times is known."""
        return self._can(
            lambda: self.lookup_transform_full(
                target_frame, target_time, source_frame, source_time, fixed_frame, timeout
            ),
            told=return_debug_tuple,
        )

    def wait_for_transform_async(
        self, target_frame: str, source_frame: str, time: Time
    ) -> Future[bool]:
        """Return a future that is done when the transform is known."""
        return self._when(lambda: bool(self.can_transform(target_frame, source_frame, time)))

    def wait_for_transform_full_async(  # as in tf2_ros
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
    ) -> Future[bool]:
        """Return a future that is done when the transform between two times is known."""
        return self._when(
            lambda: bool(
                self.can_transform_full(
                    target_frame, target_time, source_frame, source_time, fixed_frame
                )
            )
        )

    async def lookup_transform_async(self, target_frame: str, source_frame: str, time: Time) -> Any:  # noqa: ANN401
        """Wait for the transform, and return it."""
        await self.wait_for_transform_async(target_frame, source_frame, time)
        return self.lookup_transform(target_frame, source_frame, time)

    async def lookup_transform_full_async(  # as in tf2_ros
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
    ) -> Any:  # noqa: ANN401
        """Wait for the transform between two times, and return it."""
        frames = (target_frame, target_time, source_frame, source_time, fixed_frame)
        await self.wait_for_transform_full_async(*frames)
        return self.lookup_transform_full(*frames)

    def all_frames_as_yaml(self) -> str:
        """Return every frame with its parent, rates and times, in YAML."""
        frames = {
            one.frame: {"parent": one.parent, "rate": round(one.rate_hz, 3)}
            for one in self._transforms.report()
            if one.parent
        }
        return write_yaml(frames) if frames else "[]"

    def all_frames_as_string(self) -> str:
        """Return a line for each frame with its parent."""
        rows = (one for one in self._transforms.report() if one.parent)
        return "".join(f"Frame {one.frame} exists with parent {one.parent}.\n" for one in rows)

    def _put(self, transform: Any, authority: str, *, static: bool) -> None:  # noqa: ANN401
        data = _encoded(transform)
        self._transforms.put(self._codec.decode(data), static=static, publisher=authority)
        self._settle()

    def _found(self, target: str, source: str, time: Time) -> Any:  # noqa: ANN401
        pose = self._transforms.fixed_from(target, source, time.nanoseconds)
        return _stamped(target, source, pose, pose.stamp_ns or time.nanoseconds)

    def _found_full(self, target: str, source: str, fixed: str, times: tuple[Time, Time]) -> Any:  # noqa: ANN401
        target_time, source_time = times
        fixed_target = self._transforms.fixed_from(fixed, target, target_time.nanoseconds)
        fixed_source = self._transforms.fixed_from(fixed, source, source_time.nanoseconds)
        found = compose(
            inverse((*fixed_target.wxyz, *fixed_target.xyz)),
            (*fixed_source.wxyz, *fixed_source.xyz),
        )
        pose = FramePose(found[:4], found[4:], target_time.nanoseconds)
        return _stamped(target, source, pose, target_time.nanoseconds)

    def _within(self, timeout: Duration | None, find: Callable[[], Any]) -> Any:  # noqa: ANN401
        end_s = system_time.monotonic() + (timeout or _NONE).nanoseconds / NANOSECONDS
        while True:
            try:
                return find()
            except _MISSING:
                if system_time.monotonic() >= end_s:
                    raise
            system_time.sleep(_CHECK_S)

    def _can(self, find: Callable[[], Any], *, told: bool) -> Any:  # noqa: ANN401
        try:
            find()
        except FrameError as error:
            return (False, str(error)) if told else False
        return (True, "") if told else True

    def _when(self, is_there: Callable[[], bool]) -> Future[bool]:
        future: Future[bool] = Future()
        with self._lock:
            self._waiting.append((is_there, future))
        self._settle()
        return future

    def _settle(self) -> None:
        """Set the futures of what is known now."""
        if not self._waiting:
            return
        with self._lock:
            waiting = [one for one in self._waiting if not one[1].done()]
            there = [one for one in waiting if one[0]()]
            self._waiting = [one for one in waiting if one not in there]
        for _, future in there:
            future.set_result(True)

    def _serve_frames(self, node: Node) -> None:
        """Serve `tf2_frames`, as a buffer does that was given a node."""
        kind = node.context.wire.types.service("tf2_msgs/srv/FrameGraph")

        def answer(_request: object, response: Any) -> Any:  # noqa: ANN401
            response.frame_yaml = self.all_frames_as_yaml()
            return response

        node.create_service(kind, "tf2_frames", answer)


def _encoded(transform: Any) -> bytes:  # noqa: ANN401
    from studio.ros.cdr import codec_of  # noqa: PLC0415 - a buffer that only listens needs none

    kind = message("tf2_msgs/msg/TFMessage")
    return bytes(codec_of(kind).encode(kind(transforms=[transform])))


def _stamped(target: str, source: str, pose: FramePose, stamp_ns: int) -> Any:  # noqa: ANN401
    """Return a pose as a TransformStamped."""
    made: Any = message("geometry_msgs/msg/TransformStamped")()
    made.header.frame_id, made.child_frame_id = target, source
    made.header.stamp = Time(nanoseconds=stamp_ns).to_msg()
    part = made.transform
    moved, turned = part.translation, part.rotation
    moved.x, moved.y, moved.z = map(float, pose.xyz)
    turned.w, turned.x, turned.y, turned.z = map(float, pose.wxyz)
    return made

"""BufferInterface: transforms messages of the types that were registered, as tf2_ros does."""

from __future__ import annotations

from copy import deepcopy
from typing import TYPE_CHECKING, Any, ClassVar

from studio.ros.node.clock import Time

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.duration import Duration


class TypeException(Exception):  # noqa: N818  # tf2_ros's name
    """No transformation is registered for the type of a message."""


class NotImplementedException(Exception):  # noqa: N818  # tf2_ros's name
    """A buffer does not do this."""


class TransformRegistration:
    """Functions by the classes of what they transform, shared by all."""

    _transforms: ClassVar[dict[object, Callable[[Any, Any], Any]]] = {}

    def add(self, kind: object, callback: Callable[[Any, Any], Any]) -> None:
        """Register a function of (value, TransformStamped)."""
        self._transforms[kind] = callback

    def get(self, kind: object) -> Callable[[Any, Any], Any]:
        """Return the function for a class.

        Raises:
            TypeException: There is none: import tf2_geometry_msgs, which registers its own.
        """
        found = self._transforms.get(kind) or self._transforms.get(_name_of(kind))
        if found is None:
            raise TypeException(
                f"Type {getattr(kind, '__name__', kind)} if not loaded or supported: "
                "import tf2_geometry_msgs, which transforms points, poses and vectors"
            )
        return found


def _name_of(kind: object) -> str:
    return f"{getattr(kind, '__module__', '')}.{getattr(kind, '__name__', '')}"


class BufferInterface:
    """What every buffer does with its two lookups."""

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: Time, timeout: Duration | None = None
    ) -> Any:  # noqa: ANN401
        """Return the transform from one frame to another at a time.

        Raises:
            NotImplementedException: The buffer does not do this.
        """
        raise NotImplementedException

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
            NotImplementedException: The buffer does not do this.
        """
        raise NotImplementedException

    def transform(
        self,
        object_stamped: Any,  # noqa: ANN401
        target_frame: str,
        timeout: Duration | None = None,
        new_type: Any = None,  # noqa: ANN401
    ) -> Any:  # noqa: ANN401
        """Return a stamped message as seen from another frame.

        Raises:
            TypeException: No function is registered for its class.
            FrameError: The transform is not known.
        """
        do_transform = self.registration.get(object_stamped.__class__)
        found = self.lookup_transform(
            target_frame,
            object_stamped.header.frame_id,
            Time.from_msg(object_stamped.header.stamp),
            timeout,
        )
        return self._converted(do_transform(object_stamped, found), new_type)

    def transform_full(  # as in tf2_ros
        self,
        object_stamped: Any,  # noqa: ANN401
        target_frame: str,
        target_time: Time,
        fixed_frame: str,
        timeout: Duration | None = None,
        new_type: Any = None,  # noqa: ANN401
    ) -> Any:  # noqa: ANN401
        """Return a stamped message as seen from another frame at another time.

        Raises:
            TypeException: No function is registered for its class.
            FrameError: The transform is not known.
        """
        do_transform = self.registration.get(object_stamped.__class__)
        found = self.lookup_transform_full(
            target_frame,
            target_time,
            object_stamped.header.frame_id,
            Time.from_msg(object_stamped.header.stamp),
            fixed_frame,
            timeout,
        )
        return self._converted(do_transform(object_stamped, found), new_type)

    def _converted(self, value: Any, new_type: Any) -> Any:  # noqa: ANN401
        return value if new_type is None else convert(value, new_type)


def convert(value: Any, b_type: Any) -> Any:  # noqa: ANN401
    """Return a copy of a message as another class, which has the same fields.

    Raises:
        TypeException: It does not.
    """
    if type(value) is b_type:
        return deepcopy(value)
    raise TypeException(f"no conversion from {type(value).__name__} to {b_type.__name__} is known")

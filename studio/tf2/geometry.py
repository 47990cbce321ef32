"""tf2_geometry_msgs: messages of geometry_msgs as seen from another frame."""

from __future__ import annotations

from copy import deepcopy
from typing import TYPE_CHECKING, Any

import numpy as np

from studio.tf.rotations import compose, turned
from studio.tf2.buffer_interface import TransformRegistration

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.tf.rotations import Pose


def to_msg_msg(msg: Any) -> Any:  # noqa: ANN401
    """Return a message as it is."""
    return msg


from_msg_msg = to_msg_msg


def do_transform_point(point: Any, transform: Any) -> Any:  # noqa: ANN401
    """Return a PointStamped as seen from the frame of a TransformStamped."""
    made = _framed(point, transform)
    made.point.x, made.point.y, made.point.z = _moved(transform, point.point)
    return made


def do_transform_vector3(vector3: Any, transform: Any) -> Any:  # noqa: ANN401
    """Return a Vector3Stamped, which is turned and not moved."""
    made = _framed(vector3, transform)
    given, pose = vector3.vector, _pose_of(transform.transform)
    made.vector.x, made.vector.y, made.vector.z = map(
        float, turned(pose, given.x, given.y, given.z)
    )
    return made


def do_transform_pose(pose: Any, transform: Any) -> Any:  # noqa: ANN401
    """Return a Pose, which has no frame, as seen from the frame of a TransformStamped."""
    made = deepcopy(pose)
    _set_pose(made, compose(_pose_of(transform.transform), _pose(pose.orientation, pose.position)))
    return made


def do_transform_pose_stamped(pose: Any, transform: Any) -> Any:  # noqa: ANN401
    """Return a PoseStamped as seen from the frame of a TransformStamped."""
    made = _framed(pose, transform)
    made.pose = do_transform_pose(pose.pose, transform)
    return made


def do_transform_pose_with_covariance_stamped(pose: Any, transform: Any) -> Any:  # noqa: ANN401
    """Return a PoseWithCovarianceStamped, its covariance turned, too."""
    made = _framed(pose, transform)
    made.pose.pose = do_transform_pose(pose.pose.pose, transform)
    made.pose.covariance = transform_covariance(pose.pose.covariance, transform)
    return made


def transform_covariance(cov_in: Any, transform: Any) -> NDArray[Any]:  # noqa: ANN401
    """Return a covariance of 36 numbers, by rows, turned into another frame."""
    pose = _pose_of(transform.transform)
    rotation = np.zeros((6, 6))
    rotation[:3, :3] = rotation[3:, 3:] = np.array([turned(pose, *axis) for axis in np.eye(3)]).T
    given = np.asarray(cov_in, dtype=np.float64).reshape(6, 6)
    return (rotation @ given @ rotation.T).reshape(36)


def _framed(message: Any, transform: Any) -> Any:  # noqa: ANN401
    """Return a copy of a stamped message, with the header of a transform."""
    made = deepcopy(message)
    made.header = deepcopy(transform.header)
    return made


def _moved(transform: Any, point: Any) -> tuple[float, float, float]:  # noqa: ANN401
    found = compose(_pose_of(transform.transform), (1.0, 0.0, 0.0, 0.0, point.x, point.y, point.z))
    return float(found[4]), float(found[5]), float(found[6])


def _pose_of(transform: Any) -> Pose:  # noqa: ANN401
    return _pose(transform.rotation, transform.translation)


def _pose(rotation: Any, place: Any) -> Pose:  # noqa: ANN401
    return rotation.w, rotation.x, rotation.y, rotation.z, place.x, place.y, place.z


def _set_pose(pose: Any, found: Pose) -> None:  # noqa: ANN401
    place, rotation = pose.position, pose.orientation
    rotation.w, rotation.x, rotation.y, rotation.z, place.x, place.y, place.z = map(float, found)


def register() -> None:
    """Let `Buffer.transform` take these messages."""
    registration = TransformRegistration()
    for name, transform in (
        ("PointStamped", do_transform_point),
        ("Vector3Stamped", do_transform_vector3),
        ("PoseStamped", do_transform_pose_stamped),
        ("PoseWithCovarianceStamped", do_transform_pose_with_covariance_stamped),
    ):
        registration.add(f"geometry_msgs.msg.{name}", transform)

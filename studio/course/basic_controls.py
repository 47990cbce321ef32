"""Markers to move, turn and click: /basic_controls, as in the tutorial of interactive markers.

Try: `studio demos basic_controls`, then Add in *Displays*, and `/basic_controls/update` by topic.
Drag a ring or an arrow; right-click a grey box for its menu. `studio topic echo
/basic_controls/feedback` shows what the server hears. The markers are in the frame `base_link`.
"""

from __future__ import annotations

from math import sin, sqrt
from typing import TYPE_CHECKING

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.interactive_markers import InteractiveMarkerServer, MenuHandler
from studio.ros.messages.geometry_msgs.msg import (
    Point,
    Quaternion,
    TransformStamped,
    Vector3,
)
from studio.ros.messages.std_msgs.msg import ColorRGBA
from studio.ros.messages.visualization_msgs.msg import (
    InteractiveMarker,
    InteractiveMarkerControl,
    InteractiveMarkerFeedback,
    Marker,
)
from studio.tf2.broadcasters import TransformBroadcaster

if TYPE_CHECKING:
    from collections.abc import Callable

FRAME = "base_link"
MOVING_FRAME = "moving_frame"
AXES = {"x": (1.0, 0.0, 0.0), "z": (0.0, 1.0, 0.0), "y": (0.0, 0.0, 1.0)}
"""Name of each axis, and what the x of a control is turned about to be that axis."""
BOARD_M = 0.4
"""Edge of a field, to which the chess piece snaps."""


class BasicControls(Node):
    """Shows one marker of each kind, and says what people do to them."""

    def __init__(self) -> None:
        super().__init__("basic_controls")
        self.server = InteractiveMarkerServer(self, "basic_controls")
        self.menu = self.make_menu()
        self.broadcaster = TransformBroadcaster(self)
        self.seconds = 0.0

        self.add("simple_6dof", "Simple 6-DOF Control", (-1.5, 1.5), six_controls())
        self.add("fixed_6dof", "6-DOF (Fixed Orientation)", (0.0, 1.5), six_controls(fixed=True))
        self.add("view_facing", "View Facing 6-DOF", (1.5, 1.5), view_facing_controls())
        self.add("move_3d", "Move in the plane of the picture", (-1.5, 0.0), [free_control(7)])
        self.add("rotate_3d", "Turn freely", (0.0, 0.0), [free_control(8)])
        self.add("move_rotate_3d", "Move and turn freely", (1.5, 0.0), [free_control(9)])
        self.add("quadrocopter", "Quadrocopter", (-1.5, -1.5), quadrocopter_controls())
        self.add("pan_tilt", "Pan / Tilt", (0.0, -1.5), pan_tilt_controls())
        self.add("chess_piece", "Chess Piece", (1.5, -1.5), chess_controls(), self.snap)
        self.add("menu", "Menu", (-1.5, -3.0), [menu_control()])
        self.add("button", "Button", (0.0, -3.0), [button_control()])
        self.add("moving", "On a Moving Frame", (0.0, 0.0), moving_controls(), frame=MOVING_FRAME)
        for name in ("simple_6dof", "quadrocopter", "menu"):
            self.menu.apply(self.server, name)
        self.server.applyChanges()
        self.create_timer(1 / 30, self.move_frame)

    def make_menu(self) -> MenuHandler:
        """Build a menu with a submenu, and an entry with a box."""
        menu = MenuHandler()
        menu.insert("First entry", callback=self.on_entry)
        menu.insert("Second entry", callback=self.on_entry)
        submenu = menu.insert("Submenu")
        menu.insert("Entry in the submenu", parent=submenu, callback=self.on_entry)
        checked = menu.insert("With a box", callback=self.on_box)
        menu.setCheckState(checked, MenuHandler.CHECKED)
        return menu

    def add(  # one marker in one line
        self,
        name: str,
        description: str,
        place: tuple[float, float],
        controls: list[InteractiveMarkerControl],
        callback: Callable[[InteractiveMarkerFeedback], None] | None = None,
        frame: str = FRAME,
    ) -> None:
        """Insert a marker at a place of the floor, x and y in metres."""
        marker = InteractiveMarker(name=name, description=description, scale=0.7)
        marker.header.frame_id = frame
        marker.pose.position.x, marker.pose.position.y = place
        marker.controls = controls
        self.server.insert(marker, feedback_callback=callback or self.on_feedback)

    def on_feedback(self, feedback: InteractiveMarkerFeedback) -> None:
        """Take the pose of a marker, and say what was done."""
        place = feedback.pose.position
        where = f"{feedback.marker_name} / {feedback.control_name}"
        if feedback.event_type == InteractiveMarkerFeedback.POSE_UPDATE:
            self.get_logger().debug(f"{where}: {place.x:.2f} {place.y:.2f} {place.z:.2f}")
        elif feedback.event_type == InteractiveMarkerFeedback.BUTTON_CLICK:
            self.get_logger().info(f"{where}: button clicked")
        elif feedback.event_type == InteractiveMarkerFeedback.MOUSE_DOWN:
            self.get_logger().info(f"{where}: mouse down")
        elif feedback.event_type == InteractiveMarkerFeedback.MOUSE_UP:
            self.get_logger().info(f"{where}: mouse up")
        self.server.applyChanges()

    def on_entry(self, feedback: InteractiveMarkerFeedback) -> None:
        """Say which entry of a menu was chosen."""
        title = self.menu.getTitle(feedback.menu_entry_id)
        self.get_logger().info(f"{feedback.marker_name}: {title}")

    def on_box(self, feedback: InteractiveMarkerFeedback) -> None:
        """Check the entry, or uncheck it."""
        handle = feedback.menu_entry_id
        is_checked = self.menu.getCheckState(handle) == MenuHandler.CHECKED
        state = MenuHandler.UNCHECKED if is_checked else MenuHandler.CHECKED
        self.menu.setCheckState(handle, state)
        self.menu.reApply(self.server)
        self.server.applyChanges()

    def snap(self, feedback: InteractiveMarkerFeedback) -> None:
        """Keep the chess piece in the middle of a field."""
        if feedback.event_type == InteractiveMarkerFeedback.POSE_UPDATE:
            pose = feedback.pose
            pose.position.x = (round(pose.position.x / BOARD_M - 0.5) + 0.5) * BOARD_M
            pose.position.y = (round(pose.position.y / BOARD_M - 0.5) + 0.5) * BOARD_M
            self.server.setPose(feedback.marker_name, pose)
        self.server.applyChanges()

    def move_frame(self) -> None:
        """Let the moving frame swing, 30 times a second."""
        self.seconds += 1 / 30
        transform = TransformStamped()
        transform.header.stamp = self.get_clock().now().to_msg()
        transform.header.frame_id = FRAME
        transform.child_frame_id = MOVING_FRAME
        swing = 0.5 * sin(self.seconds)
        transform.transform.translation = Vector3(x=1.5 + swing, y=-3.0, z=0.5)
        transform.transform.rotation = Quaternion(z=sin(swing / 2), w=sqrt(1 - sin(swing / 2) ** 2))
        self.broadcaster.sendTransform(transform)


def control(  # the fields of a control
    mode: int,
    axis: str = "x",
    name: str = "",
    *,
    facing: int = InteractiveMarkerControl.INHERIT,
    markers: list[Marker] | None = None,
    visible: bool = False,
) -> InteractiveMarkerControl:
    """Make a control whose x is an axis of the marker; without markers it gets default handles."""
    x, y, z = AXES[axis]
    half = sqrt(0.5)
    turn = Quaternion(w=half, x=half * x, y=half * y, z=half * z)
    return InteractiveMarkerControl(
        name=name,
        orientation=turn,
        interaction_mode=mode,
        orientation_mode=facing,
        markers=markers or [],
        always_visible=visible,
    )


def box(size_m: float = 0.3, grey: float = 0.5) -> Marker:
    """Make a grey box."""
    scale = Vector3(x=size_m, y=size_m, z=size_m)
    return Marker(type=Marker.CUBE, scale=scale, color=ColorRGBA(r=grey, g=grey, b=grey, a=1.0))


def body() -> InteractiveMarkerControl:
    """Make a box that is always seen, and can only be looked at."""
    return control(InteractiveMarkerControl.NONE, name="body", markers=[box()], visible=True)


def six_controls(*, fixed: bool = False) -> list[InteractiveMarkerControl]:
    """Make a ring and two arrows for each axis."""
    facing = InteractiveMarkerControl.FIXED if fixed else InteractiveMarkerControl.INHERIT
    made = [body()]
    for axis in AXES:
        turns = InteractiveMarkerControl.ROTATE_AXIS
        moves = InteractiveMarkerControl.MOVE_AXIS
        made.append(control(turns, axis, f"rotate_{axis}", facing=facing))
        made.append(control(moves, axis, f"move_{axis}", facing=facing))
    return made


def view_facing_controls() -> list[InteractiveMarkerControl]:
    """Make a ring that turns in the picture, and a box that moves in it."""
    turns = control(
        InteractiveMarkerControl.ROTATE_AXIS,
        name="rotate",
        facing=InteractiveMarkerControl.VIEW_FACING,
    )
    turns.orientation = Quaternion(w=1.0)
    moves = control(
        InteractiveMarkerControl.MOVE_PLANE,
        name="move",
        facing=InteractiveMarkerControl.VIEW_FACING,
        markers=[box()],
        visible=True,
    )
    moves.orientation = Quaternion(w=1.0)
    moves.independent_marker_orientation = True
    return [turns, moves]


def free_control(mode: int) -> InteractiveMarkerControl:
    """Make a box that follows the mouse freely."""
    return control(mode, name="free", markers=[box(0.35)], visible=True)


def quadrocopter_controls() -> list[InteractiveMarkerControl]:
    """Make a ring that moves and turns on the floor, and arrows up and down."""
    return [
        body(),
        control(InteractiveMarkerControl.MOVE_ROTATE, "z", "move_rotate"),
        control(InteractiveMarkerControl.MOVE_AXIS, "z", "move_z"),
    ]


def pan_tilt_controls() -> list[InteractiveMarkerControl]:
    """Make a ring that pans about the upright axis, and one that tilts."""
    return [
        body(),
        control(
            InteractiveMarkerControl.ROTATE_AXIS,
            "z",
            "pan",
            facing=InteractiveMarkerControl.FIXED,
        ),
        control(InteractiveMarkerControl.ROTATE_AXIS, "y", "tilt"),
    ]


def chess_controls() -> list[InteractiveMarkerControl]:
    """Make a ring that moves on the floor, and a box that does the same."""
    moves = InteractiveMarkerControl.MOVE_PLANE
    return [
        control(moves, "z", "ring"),
        control(moves, "z", "piece", markers=[box()], visible=True),
    ]


def menu_control() -> InteractiveMarkerControl:
    """Make a box whose click opens a menu."""
    return control(InteractiveMarkerControl.MENU, name="menu", markers=[box()], visible=True)


def button_control() -> InteractiveMarkerControl:
    """Make a box that is a button."""
    return control(InteractiveMarkerControl.BUTTON, name="button", markers=[box()], visible=True)


def moving_controls() -> list[InteractiveMarkerControl]:
    """Make a ring and an arrow, for a marker that goes with its frame."""
    arrow = Marker(type=Marker.ARROW, color=ColorRGBA(r=0.9, g=0.7, b=0.1, a=1.0))
    arrow.scale = Vector3(x=0.06, y=0.12, z=0.1)
    arrow.points = [Point(), Point(z=0.4)]
    return [
        control(InteractiveMarkerControl.ROTATE_AXIS, "x", "rotate_x"),
        control(InteractiveMarkerControl.MOVE_PLANE, "x", "plane", markers=[arrow], visible=True),
    ]


def main(args: list[str] | None = None) -> None:
    """Serve the markers until stopped."""
    with until_stopped(args):
        rclpy.spin(BasicControls())


if __name__ == "__main__":
    main()

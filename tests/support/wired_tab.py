"""A tab that shows the moving graph of the demo: connected, with displays, a topic and a plot."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tests.support.studio_page import StudioPage

_CONNECT = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  await (await import(new URL("../model/ros.js", script))).connectRos();
}"""
_ADD_LIVE = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { addDisplay, liveDisplays, moveLive } = await import(
    new URL("../model/live-displays.js", script)
  );
  const kinds = [["LaserScan", "/scan"], ["Map", "/map", "Navigation"],
    ["Path", "/plan", "Navigation"], ["Odometry", "/odom", "Navigation"], ["Range", "/sonar"]];
  for (const [kind, topic, group] of kinds) {
    await addDisplay(kind, topic);
    const display = liveDisplays.value.at(-1).id;
    if (group) await moveLive({ type: "arrange_display", display, group });
  }
}"""
_LOOK_AT = """async () => {
  const script = document.querySelector('script[type="module"]').src;
  const { chosenTopic } = await import(new URL("../model/topics.js", script));
  const { series } = await import(new URL("../model/plotting.js", script));
  chosenTopic.value = "/odom";
  series.value = [".twist.twist.linear.x", ".twist.twist.angular.z", ".pose.pose.position.x"]
    .map((path) => ({ topic: "/odom", path }));
}"""


def connect(tab: StudioPage) -> None:
    """Join the ROS 2 system."""
    tab.page.evaluate(_CONNECT)


def add_displays(tab: StudioPage) -> None:
    """What the rover publishes, in the 3D view of everybody who looks at the document."""
    tab.page.evaluate(_ADD_LIVE)


def look_at_odometry(tab: StudioPage) -> None:
    """Its messages as a tree, and three of their numbers over time."""
    tab.page.evaluate(_LOOK_AT)

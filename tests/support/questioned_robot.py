"""A small robot that has one of everything that an editor can ask about."""

from __future__ import annotations

from tests.support.descriptions import robot

ARM = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <!-- One arm.
       side: left or right; length - how far it reaches -->
  <xacro:macro name="arm" params="side length:=${reach * 2} *origin">
    <link name="${side}_arm">
      <visual><geometry><box size="${length} ${reach} 0.1"/></geometry></visual>
    </link>
    <joint name="${side}_shoulder" type="fixed">
      <xacro:insert_block name="origin"/><parent link="base"/><child link="${side}_arm"/>
    </joint>
  </xacro:macro>
</robot>"""
MAIN = robot(
    """
  <xacro:arg name="kind" default="long"/>
  <!-- [0.1:2] m how far it reaches -->
  <xacro:property name="reach" value="0.5"/>
  <xacro:property name="length" value="7"/>
  <xacro:include filename="$(find robot)/urdf/arm.xacro"/>
  <xacro:include filename="sizes.xacro" ns="sizes"/>
  <xacro:property name="config" value="${xacro.load_yaml('../config/limits.yaml')}"/>
  <link name="base"><inertial>
    <mass value="${sizes.mass * config['joints']['lift'].upper}"/>
  </inertial></link>
  <xacro:arm side="left"><origin xyz="0 ${length} 0"/></xacro:arm>
  <xacro:arm side="right" length="1"><origin xyz="0 0 0"/></xacro:arm>
  <link name="$(arg kind)"/>
  <link name="${[n for n in range(3)][1]}"/>
  <gazebo reference="left_arm"/>
  <xacro:if value="0"><link name="${reach}"/></xacro:if>
"""
)
FILES: dict[str, str | bytes] = {
    "urdf/robot.xacro": MAIN,
    "urdf/arm.xacro": ARM,
    "urdf/sizes.xacro": robot('<xacro:property name="mass" value="3"/>'),
    "config/limits.yaml": "joints:\n  lift:\n    lower: -1\n    upper: 2.5  # up\n",
    "package.xml": "<package><name>robot</name></package>",
}

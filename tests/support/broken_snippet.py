"""The course's first listing of a robot, with the faults that it has in print."""

PRINTED = """<robot name="mv_robot">
 <link name="base link">
    <visual>
      <geometry>
        <box size="1 1 1"/>
     </geometry>
    </visual>
 </link>
 <joint name="joint1" type="continuous">
    <parent link="base_link"/>
    <child link="wheel_link"/>
    <origin xyz="0 1 0" rpy="0 0 0"/>
    <axis xyz="0 0 1"/>
 </joint>
"""

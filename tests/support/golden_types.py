"""Fields of interfaces as their packages define them, one text per type, for the golden files.

`;` parts fields, `---` the parts of a call. Nothing here is read from the studio.
"""

from __future__ import annotations

TYPES = {
    "builtin_interfaces/msg/Time": "int32 sec; uint32 nanosec",
    "builtin_interfaces/msg/Duration": "int32 sec; uint32 nanosec",
    "std_msgs/msg/Header": "builtin_interfaces/Time stamp; string frame_id",
    "std_msgs/msg/String": "string data",
    "std_msgs/msg/Char": "char data",
    "std_msgs/msg/Byte": "byte data",
    "std_msgs/msg/Bool": "bool data",
    "std_msgs/msg/Int64": "int64 data",
    "std_msgs/msg/Empty": "",
    "std_msgs/msg/ColorRGBA": "float32 r; float32 g; float32 b; float32 a",
    "geometry_msgs/msg/Point": "float64 x; float64 y; float64 z",
    "geometry_msgs/msg/Vector3": "float64 x; float64 y; float64 z",
    "geometry_msgs/msg/Quaternion": "float64 x; float64 y; float64 z; float64 w",
    "geometry_msgs/msg/Pose": "Point position; Quaternion orientation",
    "geometry_msgs/msg/Twist": "Vector3 linear; Vector3 angular",
    "geometry_msgs/msg/Transform": "Vector3 translation; Quaternion rotation",
    "geometry_msgs/msg/TransformStamped": "std_msgs/Header header; string child_frame_id; "
    "Transform transform",
    "tf2_msgs/msg/TFMessage": "geometry_msgs/TransformStamped[] transforms",
    "sensor_msgs/msg/JointState": "std_msgs/Header header; string[] name; float64[] position; "
    "float64[] velocity; float64[] effort",
    "sensor_msgs/msg/LaserScan": "std_msgs/Header header; float32 angle_min; float32 angle_max; "
    "float32 angle_increment; float32 time_increment; float32 scan_time; float32 range_min; "
    "float32 range_max; float32[] ranges; float32[] intensities",
    "sensor_msgs/msg/Range": "std_msgs/Header header; uint8 radiation_type; "
    "float32 field_of_view; float32 min_range; float32 max_range; float32 range; float32 variance",
    "sensor_msgs/msg/Imu": "std_msgs/Header header; geometry_msgs/Quaternion orientation; "
    "float64[9] orientation_covariance; geometry_msgs/Vector3 angular_velocity; "
    "float64[9] angular_velocity_covariance; geometry_msgs/Vector3 linear_acceleration; "
    "float64[9] linear_acceleration_covariance",
    "sensor_msgs/msg/BatteryState": "std_msgs/Header header; float32 voltage; "
    "float32 temperature; float32 current; float32 charge; float32 capacity; "
    "float32 design_capacity; float32 percentage; uint8 power_supply_status; "
    "uint8 power_supply_health; uint8 power_supply_technology; bool present; "
    "float32[] cell_voltage; float32[] cell_temperature; string location; string serial_number",
    "sensor_msgs/msg/CompressedImage": "std_msgs/Header header; string format; uint8[] data",
    "visualization_msgs/msg/UVCoordinate": "float32 u; float32 v",
    "visualization_msgs/msg/MeshFile": "string filename; uint8[] data",
    "visualization_msgs/msg/Marker": "std_msgs/Header header; string ns; int32 id; int32 type; "
    "int32 action; geometry_msgs/Pose pose; geometry_msgs/Vector3 scale; std_msgs/ColorRGBA color; "
    "builtin_interfaces/Duration lifetime; bool frame_locked; geometry_msgs/Point[] points; "
    "std_msgs/ColorRGBA[] colors; string texture_resource; sensor_msgs/CompressedImage texture; "
    "UVCoordinate[] uv_coordinates; string text; string mesh_resource; MeshFile mesh_file; "
    "bool mesh_use_embedded_materials",
    "visualization_msgs/msg/MarkerArray": "Marker[] markers",
    "rosgraph_msgs/msg/Clock": "builtin_interfaces/Time clock",
    "unique_identifier_msgs/msg/UUID": "uint8[16] uuid",
    "action_msgs/msg/GoalInfo": "unique_identifier_msgs/UUID goal_id; "
    "builtin_interfaces/Time stamp",
    "action_msgs/msg/GoalStatus": "GoalInfo goal_info; int8 status",
    "action_msgs/msg/GoalStatusArray": "GoalStatus[] status_list",
    "service_msgs/msg/ServiceEventInfo": "uint8 event_type; builtin_interfaces/Time stamp; "
    "char[16] client_gid; int64 sequence_number",
    "rcl_interfaces/msg/Log": "builtin_interfaces/Time stamp; uint8 level; string name; "
    "string msg; string file; string function; uint32 line",
    "rcl_interfaces/msg/ParameterValue": "uint8 type; bool bool_value; int64 integer_value; "
    "float64 double_value; string string_value; byte[] byte_array_value; bool[] bool_array_value; "
    "int64[] integer_array_value; float64[] double_array_value; string[] string_array_value",
    "rcl_interfaces/msg/Parameter": "string name; ParameterValue value",
    "rcl_interfaces/msg/ParameterEvent": "builtin_interfaces/Time stamp; string node; "
    "Parameter[] new_parameters; Parameter[] changed_parameters; Parameter[] deleted_parameters",
    "rcl_interfaces/msg/ListParametersResult": "string[] names; string[] prefixes",
    "rcl_interfaces/msg/SetParametersResult": "bool successful; string reason",
    "rcl_interfaces/msg/FloatingPointRange": "float64 from_value; float64 to_value; float64 step",
    "rcl_interfaces/msg/IntegerRange": "int64 from_value; int64 to_value; uint64 step",
    "rcl_interfaces/msg/ParameterDescriptor": "string name; uint8 type; string description; "
    "string additional_constraints; bool read_only; bool dynamic_typing; "
    "FloatingPointRange[<=1] floating_point_range; IntegerRange[<=1] integer_range",
    "lifecycle_msgs/msg/State": "uint8 id; string label",
    "lifecycle_msgs/msg/Transition": "uint8 id; string label",
    "lifecycle_msgs/msg/TransitionEvent": "uint64 timestamp; Transition transition; "
    "State start_state; State goal_state",
    "std_srvs/srv/Empty": "---",
    "std_srvs/srv/Trigger": "---bool success; string message",
    "std_srvs/srv/SetBool": "bool data---bool success; string message",
    "example_interfaces/srv/AddTwoInts": "int64 a; int64 b---int64 sum",
    "action_msgs/srv/CancelGoal": "GoalInfo goal_info---int8 return_code; "
    "GoalInfo[] goals_canceling",
    "lifecycle_msgs/srv/GetState": "---State current_state",
    "lifecycle_msgs/srv/ChangeState": "Transition transition---bool success",
    "rcl_interfaces/srv/ListParameters": "string[] prefixes; uint64 depth---"
    "ListParametersResult result",
    "rcl_interfaces/srv/GetParameters": "string[] names---ParameterValue[] values",
    "rcl_interfaces/srv/GetParameterTypes": "string[] names---uint8[] types",
    "rcl_interfaces/srv/SetParameters": "Parameter[] parameters---SetParametersResult[] results",
    "rcl_interfaces/srv/SetParametersAtomically": "Parameter[] parameters---"
    "SetParametersResult result",
    "rcl_interfaces/srv/DescribeParameters": "string[] names---ParameterDescriptor[] descriptors",
    "type_description_interfaces/msg/KeyValue": "string key; string value",
    "type_description_interfaces/msg/FieldType": "uint8 type_id; uint64 capacity; "
    "uint64 string_capacity; string<=255 nested_type_name",
    "type_description_interfaces/msg/Field": "string name; FieldType type; string default_value",
    "type_description_interfaces/msg/IndividualTypeDescription": "string<=255 type_name; "
    "Field[] fields",
    "type_description_interfaces/msg/TypeDescription": "IndividualTypeDescription "
    "type_description; IndividualTypeDescription[] referenced_type_descriptions",
    "type_description_interfaces/msg/TypeSource": "string type_name; string encoding; "
    "string raw_file_contents",
    "type_description_interfaces/srv/GetTypeDescription": "string type_name; string type_hash; "
    "bool include_type_sources true---bool successful; string failure_reason; "
    "TypeDescription type_description; TypeSource[] type_sources; KeyValue[] extra_information",
    "example_interfaces/action/Fibonacci": "int32 order---int32[] sequence---int32[] sequence",
}

CHANGED = {
    "humble": {
        "sensor_msgs/msg/Range": "std_msgs/Header header; uint8 radiation_type; "
        "float32 field_of_view; float32 min_range; float32 max_range; float32 range",
    },
    "jazzy": {},
    "kilted": {
        "nav_msgs/msg/Goals": "std_msgs/Header header; geometry_msgs/PoseStamped[] goals",
        "geometry_msgs/msg/PoseStamped": "std_msgs/Header header; Pose pose",
    },
}
"""What a distribution has otherwise or in addition."""

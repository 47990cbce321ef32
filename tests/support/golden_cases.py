"""What the golden files of the wire hold: names, qualities, numbers and values, written by hand."""

from __future__ import annotations

from typing import Any

NODE: dict[str, Any] = {
    "domain": 2,
    "zid": "8b20917502ee955ac4476e0266340d5c",
    "nid": 0,
    "enclave": "/",
    "namespace": "/",
    "name": "talker",
}

KEYS: list[dict[str, Any]] = [
    {"domain": 0, "name": "/chatter", "type": "std_msgs/msg/String"},
    {"domain": 0, "name": "/robot1/chatter", "type": "std_msgs/msg/String"},
    {"domain": 232, "name": "/a/b/c/_d", "type": "sensor_msgs/msg/JointState"},
    {"domain": 7, "name": "/range", "type": "sensor_msgs/msg/Range"},
    {"domain": 0, "name": "/add_two_ints", "type": "example_interfaces/srv/AddTwoInts"},
    {"domain": 0, "name": "/talker/get_parameters", "type": "rcl_interfaces/srv/GetParameters"},
    {"domain": 0, "name": "/count/_action/send_goal",
     "type": "example_interfaces/action/Fibonacci_SendGoal"},
    {"domain": 0, "name": "/count/_action/get_result",
     "type": "example_interfaces/action/Fibonacci_GetResult"},
    {"domain": 0, "name": "/count/_action/cancel_goal", "type": "action_msgs/srv/CancelGoal"},
    {"domain": 0, "name": "/count/_action/feedback",
     "type": "example_interfaces/action/Fibonacci_FeedbackMessage"},
    {"domain": 0, "name": "/count/_action/status", "type": "action_msgs/msg/GoalStatusArray"},
]  # fmt: skip

# Qualities by rclpy's names; a lifespan and the like in nanoseconds, policies as rmw numbers them.
TOKENS: list[dict[str, Any]] = [
    {"kind": "NN"},
    {"kind": "NN", "node": {"namespace": "/a/b", "enclave": "/lab/one", "nid": 41, "domain": 0}},
    {"kind": "MP", "eid": 10, "topic": "/chatter", "type": "std_msgs/msg/String",
     "qos": {"depth": 7}, "qos_text": "::,7:,:,:,,"},
    {"kind": "MP", "eid": 1, "topic": "/a/b/chatter", "type": "std_msgs/msg/String",
     "node": {"namespace": "/a/b"}, "qos": {"depth": 42}, "qos_text": "::,:,:,:,,"},
    {"kind": "MS", "eid": 2, "topic": "/scan", "type": "sensor_msgs/msg/LaserScan",
     "qos": {"reliability": 2, "depth": 5}, "qos_text": "2::,5:,:,:,,"},
    {"kind": "MP", "eid": 3, "topic": "/tf_static", "type": "tf2_msgs/msg/TFMessage",
     "qos": {"durability": 1, "depth": 1}, "qos_text": ":1:,1:,:,:,,"},
    {"kind": "MP", "eid": 4, "topic": "/rosout", "type": "rcl_interfaces/msg/Log",
     "qos": {"durability": 1, "depth": 1000, "lifespan_ns": 10_000_000_000},
     "qos_text": ":1:,1000:,:10,0:,,"},
    {"kind": "MP", "eid": 5, "topic": "/all", "type": "std_msgs/msg/Bool",
     "qos": {"history": 2, "depth": 0}, "qos_text": "::2,:,:,:,,"},
    {"kind": "MP", "eid": 6, "topic": "/often", "type": "std_msgs/msg/Int64",
     "qos": {"depth": 1, "deadline_ns": 100_000_000, "liveliness": 3, "lease_ns": 2_500_000_000},
     "qos_text": "::,1:0,100000000:,:3,2,500000000"},
    {"kind": "SS", "eid": 7, "topic": "/add_two_ints", "type": "example_interfaces/srv/AddTwoInts",
     "qos": {"depth": 10}, "qos_text": "::,10:,:,:,,"},
    {"kind": "SC", "eid": 8, "topic": "/talker/get_parameters",
     "type": "rcl_interfaces/srv/GetParameters",
     "qos": {"depth": 1000}, "qos_text": "::,1000:,:,:,,"},
    {"kind": "MS", "eid": 9, "topic": "/image", "type": "sensor_msgs/msg/CompressedImage",
     "qos": {"reliability": 2, "depth": 5}, "qos_text": "2::,5:,:,:,,",
     "extra": ["backends:cpu:"]},
    {"kind": "SS", "eid": 11, "topic": "/count/_action/get_result",
     "type": "example_interfaces/action/Fibonacci_GetResult",
     "qos": {"depth": 10}, "qos_text": "::,10:,:,:,,"},
]  # fmt: skip

ATTACHMENTS: list[dict[str, Any]] = [
    {"sequence": 1, "source_time_ns": 0, "gid": "00" * 16},
    {"sequence": 1, "source_time_ns": 1_763_733_600_123_456_789,
     "gid": "000102030405060708090a0b0c0d0e0f"},
    {"sequence": 2**63 - 1, "source_time_ns": 2**63 - 1, "gid": "ff" * 16},
]  # fmt: skip

_STAMP = {"sec": 1_763_733_600, "nanosec": 999_999_999}
_HEADER = {"stamp": _STAMP, "frame_id": "base_link"}
_POSE = {
    "position": {"x": 1.0, "y": -2.5, "z": 0.125},
    "orientation": {"x": 0.0, "y": 0.0, "z": 0.6, "w": 0.8},
}
_COLOR = {"r": 0.5, "g": 0.25, "b": 1.0, "a": 1.0}
_MARKER: dict[str, Any] = {
    "header": _HEADER, "ns": "lane", "id": -7, "type": 4, "action": 0, "pose": _POSE,
    "scale": {"x": 0.05, "y": 0.0, "z": 0.0}, "color": _COLOR,
    "lifetime": {"sec": 1, "nanosec": 5}, "frame_locked": True,
    "points": [{"x": 0.0, "y": 0.1, "z": 0.2}, {"x": 3.0, "y": 4.0, "z": 5.0}],
    "colors": [_COLOR], "texture_resource": "", "texture":
    {"header": {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}, "format": "png",
     "data": [1, 2, 3]},
    "uv_coordinates": [{"u": 0.5, "v": 0.75}], "text": "größer",
    "mesh_resource": "package://p/m.dae", "mesh_file": {"filename": "", "data": []},
    "mesh_use_embedded_materials": True,
}  # fmt: skip
_UUID = {"uuid": list(range(16))}

CDR: list[dict[str, Any]] = [
    {"type": "std_msgs/msg/String", "value": {"data": ""}},
    {"type": "std_msgs/msg/String", "value": {"data": "hi é 🤖"}},
    {"type": "std_msgs/msg/Empty", "value": {}},
    {"type": "std_msgs/msg/Char", "value": {"data": 200}},
    {"type": "std_msgs/msg/Byte", "value": {"data": 255}},
    {"type": "std_msgs/msg/Int64", "value": {"data": -(2**63)}},
    {"type": "std_srvs/srv/Trigger_Request", "value": {}},
    {"type": "std_srvs/srv/Trigger_Response", "value": {"success": True, "message": "done"}},
    {"type": "example_interfaces/srv/AddTwoInts_Request", "value": {"a": 2, "b": -3}},
    {"type": "geometry_msgs/msg/Twist", "value": {
        "linear": {"x": 0.5, "y": 0.0, "z": -0.0}, "angular": {"x": 0.0, "y": 0.0, "z": 1e-300}}},
    {"type": "sensor_msgs/msg/JointState", "value": {
        "header": _HEADER, "name": ["arm", "hand_1"], "position": [0.5, -0.5], "velocity": [],
        "effort": [1.5]}},
    {"type": "sensor_msgs/msg/LaserScan", "value": {
        "header": _HEADER, "angle_min": -1.5, "angle_max": 1.5, "angle_increment": 0.75,
        "time_increment": 0.0, "scan_time": 0.125, "range_min": 0.5, "range_max": 30.0,
        "ranges": [1.0, 2.0, 3.0, 4.0, 5.0], "intensities": [0.5]}},
    {"type": "tf2_msgs/msg/TFMessage", "value": {"transforms": []}},
    {"type": "tf2_msgs/msg/TFMessage", "value": {"transforms": [
        {"header": _HEADER, "child_frame_id": child, "transform":
         {"translation": _POSE["position"], "rotation": _POSE["orientation"]}}
        for child in ("a", "wheel_left", "é")]}},
    {"type": "visualization_msgs/msg/MarkerArray", "value": {"markers": []}},
    {"type": "visualization_msgs/msg/MarkerArray", "value": {"markers": [
        _MARKER, _MARKER | {"ns": "x", "points": [], "colors": [], "text": ""}, _MARKER]}},
    {"type": "rcl_interfaces/msg/ParameterValue", "value": {
        "type": 9, "bool_value": False, "integer_value": -1, "double_value": 0.1,
        "string_value": "x", "byte_array_value": [0, 255], "bool_array_value": [True, False, True],
        "integer_array_value": [2**63 - 1], "double_array_value": [], "string_array_value":
        ["", "abc"]}},
    {"type": "rcl_interfaces/msg/Log", "value": {
        "stamp": _STAMP, "level": 30, "name": "talker", "msg": "low", "file": "t.py",
        "function": "f", "line": 12}},
    {"type": "rosgraph_msgs/msg/Clock", "value": {"clock": _STAMP}},
    {"type": "action_msgs/msg/GoalStatusArray", "value": {"status_list": [
        {"goal_info": {"goal_id": _UUID, "stamp": _STAMP}, "status": 4}]}},
    {"type": "example_interfaces/action/Fibonacci_SendGoal_Request", "value": {
        "goal_id": _UUID, "goal": {"order": 5}}},
    {"type": "example_interfaces/action/Fibonacci_GetResult_Response", "value": {
        "status": 4, "result": {"sequence": [0, 1, 1, 2, 3]}}},
    {"type": "lifecycle_msgs/msg/TransitionEvent", "value": {
        "timestamp": 2**64 - 1, "transition": {"id": 3, "label": "activate"},
        "start_state": {"id": 2, "label": "inactive"},
        "goal_state": {"id": 3, "label": "active"}}},
]  # fmt: skip

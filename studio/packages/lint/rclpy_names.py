"""Names that rclpy has, as facts, for finding misspelt ones."""

from __future__ import annotations

from typing import Final

RCLPY_NAMES: Final = frozenset({
        "action", "callback_groups", "client", "clock", "context", "create_node", "duration",
        "event_handler", "exceptions", "executors", "expand_topic_name", "experimental",
        "get_default_context", "get_global_executor", "get_rmw_implementation_identifier",
        "guard_condition", "handle", "impl", "init", "lifecycle", "logging", "node", "ok",
        "parameter", "parameter_client", "parameter_event_handler", "parameter_service",
        "publisher", "qos", "qos_event", "qos_overriding_options", "serialization", "service",
        "service_introspection", "shutdown", "signals", "spin", "spin_once",
        "spin_until_future_complete", "subscription", "subscription_content_filter_options",
        "task", "time", "time_source", "timer", "topic_endpoint_info",
        "topic_or_service_is_hidden", "try_shutdown", "type_description_service", "type_hash",
        "type_support", "uninstall_signal_handlers", "utilities", "validate_full_topic_name",
        "validate_namespace", "validate_node_name", "validate_parameter_name",
        "validate_topic_name", "wait_for_message", "waitable",
})  # fmt: skip
NODE_NAMES: Final = frozenset({
        "add_on_set_parameters_callback", "add_post_set_parameters_callback",
        "add_pre_set_parameters_callback", "add_waitable", "assert_liveliness", "clients",
        "context", "count_clients", "count_publishers", "count_services", "count_subscribers",
        "create_client", "create_guard_condition", "create_publisher", "create_rate",
        "create_service", "create_subscription", "create_timer", "declare_parameter",
        "declare_parameters", "default_callback_group", "describe_parameter",
        "describe_parameters", "destroy_client", "destroy_guard_condition", "destroy_node",
        "destroy_publisher", "destroy_rate", "destroy_service", "destroy_subscription",
        "destroy_timer", "executor", "get_client_names_and_types_by_node",
        "get_clients_info_by_service", "get_clock", "get_effective_parameters",
        "get_fully_qualified_node_names", "get_logger", "get_name", "get_namespace",
        "get_node_names", "get_node_names_and_namespaces",
        "get_node_names_and_namespaces_with_enclaves", "get_parameter", "get_parameter_or",
        "get_parameter_type", "get_parameters", "get_parameters_by_prefix",
        "get_publisher_names_and_types_by_node", "get_publishers_info_by_topic",
        "get_servers_info_by_service", "get_service_names_and_types",
        "get_service_names_and_types_by_node", "get_subscriber_names_and_types_by_node",
        "get_subscriptions_info_by_topic", "get_topic_names_and_types", "guards", "handle",
        "has_parameter", "list_parameters", "publishers", "remove_on_set_parameters_callback",
        "remove_post_set_parameters_callback", "remove_pre_set_parameters_callback",
        "remove_waitable", "resolve_service_name", "resolve_topic_name", "services",
        "set_descriptor", "set_parameters", "set_parameters_atomically", "subscriptions",
        "timers", "undeclare_parameter", "wait_for_node", "waitables",
})  # fmt: skip
CALL_PARTS: Final = {
    "srv": frozenset({"Request", "Response", "Event"}),
    "action": frozenset({"Goal", "Result", "Feedback", "Impl"}),
}
"""What the class of a service or an action has."""
HOMES: Final = {
    "Node": "rclpy.node",
    "QoSProfile": "rclpy.qos",
    "ReliabilityPolicy": "rclpy.qos",
    "DurabilityPolicy": "rclpy.qos",
    "HistoryPolicy": "rclpy.qos",
    "qos_profile_sensor_data": "rclpy.qos",
    "ActionServer": "rclpy.action",
    "ActionClient": "rclpy.action",
    "GoalResponse": "rclpy.action",
    "CancelResponse": "rclpy.action",
    "MultiThreadedExecutor": "rclpy.executors",
    "SingleThreadedExecutor": "rclpy.executors",
    "ExternalShutdownException": "rclpy.executors",
    "ReentrantCallbackGroup": "rclpy.callback_groups",
    "MutuallyExclusiveCallbackGroup": "rclpy.callback_groups",
    "Parameter": "rclpy.parameter",
    "SetParametersResult": "rcl_interfaces.msg",
    "ParameterDescriptor": "rcl_interfaces.msg",
    "TransformBroadcaster": "tf2_ros",
    "StaticTransformBroadcaster": "tf2_ros",
    "TransformListener": "tf2_ros",
    "Buffer": "tf2_ros",
    "get_package_share_directory": "ament_index_python.packages",
    "LaunchDescription": "launch",
}
"""Where the names are imported of that nodes use most."""

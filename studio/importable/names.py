"""Names of ROS's modules in Python, and what each of them is here: a table, nothing is imported.

A row is `name`, or `name=attribute` where it is called otherwise here; rows of one source follow
its module.
"""

from __future__ import annotations

from typing import Final

_QOS: Final = """
    studio.importable.rclpy_parts.qos: QoSProfile QoSPresetProfiles QoSCompatibility
      QoSPolicyEnum InvalidQoSProfileException qos_check_compatible qos_policy_name_from_kind
      HistoryPolicy ReliabilityPolicy DurabilityPolicy LivelinessPolicy
      QoSHistoryPolicy=HistoryPolicy QoSReliabilityPolicy=ReliabilityPolicy
      QoSDurabilityPolicy=DurabilityPolicy QoSLivelinessPolicy=LivelinessPolicy
      DeadlineBestAvailable LivelinessLeaseDurationeBestAvailable
      qos_profile_sensor_data qos_profile_services_default qos_profile_parameters
      qos_profile_parameter_events qos_profile_action_status_default qos_profile_system_default
      qos_profile_best_available qos_profile_default qos_profile_unknown
    studio.ros.node.qos_overriding_options: QoSPolicyKind
    studio.ros.duration: Duration
"""
_ACTIONS: Final = """
    studio.importable.rclpy_parts.graph: get_action_names_and_types
      get_action_client_names_and_types_by_node get_action_server_names_and_types_by_node
"""
_EVENTS: Final = """
    studio.ros.node.event_handler: PublisherEventCallbacks SubscriptionEventCallbacks
      QoSPublisherMatchedInfo QoSSubscriptionMatchedInfo QoSMessageLostInfo IncompatibleTypeInfo
    studio.importable.rclpy_parts.events: QoSOfferedIncompatibleQoSInfo
      QoSRequestedIncompatibleQoSInfo QoSOfferedDeadlineMissedInfo QoSRequestedDeadlineMissedInfo
      QoSLivelinessChangedInfo QoSLivelinessLostInfo QoSPublisherEventType
      QoSSubscriptionEventType
    studio.errors: UnsupportedEventTypeError
    studio.ros.node.work: CallbackGroup
"""
_PARAMETER: Final = """
    studio.ros.parameters.parameter: Parameter
    studio.importable.rclpy_parts.parameters: PARAMETER_SEPARATOR_STRING get_parameter_value
      parameter_dict_from_yaml_file parameter_value_to_python
"""
_TF2_GEOMETRY: Final = """
    studio.tf2.geometry: do_transform_point do_transform_vector3 do_transform_pose
      do_transform_pose_stamped do_transform_pose_with_covariance_stamped to_msg_msg
      from_msg_msg transform_covariance
"""
_TABLE: Final = {
    "rclpy": """
        studio.ros.node.spinning: create_node get_global_executor init ok shutdown spin spin_once
          spin_until_future_complete try_shutdown
        studio.ros.node.context: Context get_default_context=default_context
        studio.ros.node.task: Future
        studio.ros.parameters.parameter: Parameter
        studio.ros.node.signals: SignalHandlerOptions
        studio.importable.rclpy_parts.processes: install_signal_handlers uninstall_signal_handlers
          get_rmw_implementation_identifier
    """,
    "rclpy.action": """
        studio.ros.action: ActionClient ActionServer CancelResponse GoalResponse
    """
    + _ACTIONS,
    "rclpy.action.client": """
        studio.ros.action: ActionClient ClientGoalHandle
        studio.ros.action.protocol: GoalStatus
        studio.ros.node.task: Future
    """,
    "rclpy.action.graph": _ACTIONS,
    "rclpy.action.server": """
        studio.ros.action: ActionServer CancelResponse GoalResponse ServerGoalHandle
        studio.ros.action.server: default_goal_callback default_handle_accepted_callback
          default_cancel_callback
        studio.ros.action.protocol: GoalEvent GoalStatus
        studio.ros.node.task: Future
    """,
    "rclpy.callback_groups": """
        studio.ros.node.work: CallbackGroup MutuallyExclusiveCallbackGroup ReentrantCallbackGroup
    """,
    "rclpy.client": """
        studio.ros.node.service_client: Client
        studio.ros.node.task: Future
    """,
    "rclpy.clock": """
        studio.ros.node.clock: Clock ClockChange ClockType JumpHandle JumpThreshold ROSClock Time
          TimeJump
        studio.ros.duration: Duration
    """,
    "rclpy.clock_type": "studio.ros.node.clock: ClockType",
    "rclpy.constants": "studio.ros.duration: S_TO_NS=NANOSECONDS",
    "rclpy.context": """
        studio.ros.node.context: Context
    """,
    "rclpy.duration": """
        studio.ros.duration: Duration Infinite=INFINITE S_TO_NS=NANOSECONDS
    """,
    "rclpy.event_handler": _EVENTS,
    "rclpy.qos_event": _EVENTS,
    "rclpy.exceptions": """
        studio.ros.exceptions: ParameterException ParameterAlreadyDeclaredException
          ParameterNotDeclaredException ParameterImmutableException
          ParameterUninitializedException InvalidParameterTypeException
          InvalidParameterValueException
        studio.importable.rclpy_parts.exceptions: InvalidHandle InvalidNamespaceException
          InvalidNodeNameException InvalidParameterException InvalidServiceNameException
          InvalidTopicNameException NameValidationException NoTypeSupportImportedException
          NotInitializedException ROSInterruptException TimerCancelledError
    """,
    "rclpy.executors": """
        studio.ros.node.executors: Executor MultiThreadedExecutor SingleThreadedExecutor
        studio.errors: ExternalShutdownException
        studio.importable.rclpy_parts.exceptions: ConditionReachedException ShutdownException
          TimeoutException TimerCancelledError InvalidHandle
        studio.ros.node.task: Future Task
        studio.ros.node.work: GuardCondition
        studio.ros.node.timer: Timer
        studio.ros.node.context: Context get_default_context=default_context
        studio.importable.rclpy_parts.processes: timeout_sec_to_nsec
    """,
    "rclpy.expand_topic_name": "studio.importable.rclpy_parts.validation: expand_topic_name",
    "rclpy.guard_condition": "studio.ros.node.work: GuardCondition",
    "rclpy.impl": "",
    "rclpy.impl.implementation_singleton": "",
    "rclpy.impl.logging_severity": "studio.ros.node.logger: LoggingSeverity",
    "rclpy.impl.rcutils_logger": """
        studio.ros.node.logger: LoggingSeverity RcutilsLogger=Logger
    """,
    "rclpy.lifecycle": """
        studio.ros.lifecycle: LifecycleNode LifecyclePublisher LifecycleState
          TransitionCallbackReturn ManagedEntity State=LifecycleState Node=LifecycleNode
          Publisher=LifecyclePublisher
    """,
    "rclpy.lifecycle.node": """
        studio.ros.lifecycle: LifecycleNode LifecycleState TransitionCallbackReturn
          LifecyclePublisher
    """,
    "rclpy.lifecycle.publisher": "studio.ros.lifecycle: LifecyclePublisher",
    "rclpy.lifecycle.managed_entity": """
        studio.ros.lifecycle: ManagedEntity TransitionCallbackReturn
    """,
    "rclpy.logging": """
        studio.ros.node.logger: RcutilsLogger=Logger
        studio.importable.rclpy_parts.logging: LoggingSeverity clear_config get_logger
          get_logger_effective_level get_logger_level get_logging_directory
          get_logging_severity_from_string initialize set_logger_level shutdown
    """,
    "rclpy.node": """
        studio.ros.node.node: Node
        studio.ros.node.service_client: Client
        studio.ros.node.service: Service
        studio.ros.node.publisher: Publisher
        studio.ros.node.subscription: Subscription
        studio.ros.node.timer: Rate Timer
        studio.ros.node.clock: Clock ROSClock TimeSource
        studio.ros.node.context: Context
        studio.ros.node.executors: Executor
        studio.ros.node.work: CallbackGroup GuardCondition MutuallyExclusiveCallbackGroup
          ReentrantCallbackGroup
        studio.ros.node.event_handler: PublisherEventCallbacks SubscriptionEventCallbacks
        studio.ros.node.qos_overriding_options: QoSOverridingOptions
        studio.ros.parameters.parameter: Parameter
        studio.importable.rclpy_parts.qos: QoSProfile qos_profile_parameter_events
          qos_profile_services_default
        studio.importable.rclpy_parts.exceptions: NodeNameNonExistentError InvalidHandle
          InvalidTopicNameException NotInitializedException
        studio.ros.exceptions: ParameterAlreadyDeclaredException ParameterImmutableException
          ParameterNotDeclaredException ParameterUninitializedException
          InvalidParameterTypeException InvalidParameterValueException
        studio.importable.rclpy_parts.messages: FloatingPointRange IntegerRange ListParameters
          ListParametersResult ParameterDescriptor ParameterEvent ParameterMsg ParameterType
          ParameterValue SetParametersResult
        studio.importable.rclpy_parts.parameters: PARAMETER_SEPARATOR_STRING
        studio.ros.graph.endpoints: TopicEndpointInfo=GraphEndpoint
        studio.importable.rclpy_parts.validation: HIDDEN_NODE_PREFIX expand_topic_name
          validate_full_topic_name validate_namespace validate_node_name
          validate_parameter_name validate_topic_name
        studio.importable.rclpy_parts.type_support: check_is_valid_msg_type
          check_is_valid_srv_type
        studio.importable.rclpy_parts.logging: get_logger
        studio.ros.duration: S_TO_NS=NANOSECONDS
    """,
    "rclpy.parameter": _PARAMETER
    + """
        studio.importable.rclpy_parts.messages: ParameterMsg ParameterType ParameterValue
    """,
    "rclpy.parameter_client": "studio.importable.rclpy_parts.parameters: AsyncParameterClient",
    "rclpy.parameter_event_handler": """
        studio.importable.rclpy_parts.parameter_event_handler: ParameterEventHandler
          ParameterCallbackHandle ParameterEventCallbackHandle
    """,
    "rclpy.publisher": "studio.ros.node.publisher: Publisher",
    "rclpy.qos": _QOS,
    "rclpy.qos_overriding_options": """
        studio.ros.node.qos_overriding_options: QoSOverridingOptions QosCallbackResult
          QoSPolicyKind
        studio.errors: InvalidQosOverridesError=QosOverrideError
    """,
    "rclpy.serialization": """
        studio.importable.rclpy_parts.messages: deserialize_message serialize_message
    """,
    "rclpy.service": "studio.ros.node.service: Service",
    "rclpy.service_introspection": """
        studio.importable.rclpy_parts.processes: ServiceIntrospectionState
    """,
    "rclpy.signals": """
        studio.ros.node.signals: SignalHandlerOptions
        studio.importable.rclpy_parts.processes: install_signal_handlers uninstall_signal_handlers
          get_current_signal_handlers_options
    """,
    "rclpy.subscription": "studio.ros.node.subscription: Subscription",
    "rclpy.task": "studio.ros.node.task: Future Task",
    "rclpy.time": """
        studio.ros.node.clock: Time ClockType
        studio.ros.duration: Duration S_TO_NS=NANOSECONDS
    """,
    "rclpy.time_source": """
        studio.ros.node.clock: TimeSource CLOCK_TOPIC
        studio.ros.parameters.node_parameters: USE_SIM_TIME_NAME=USE_SIM_TIME
    """,
    "rclpy.timer": """
        studio.ros.node.timer: Rate Timer
        studio.importable.rclpy_parts.exceptions: ROSInterruptException InvalidHandle
    """,
    "rclpy.topic_endpoint_info": """
        studio.ros.graph.endpoints: TopicEndpointInfo=GraphEndpoint
        studio.importable.rclpy_parts.graph: TopicEndpointTypeEnum TypeHash
    """,
    "rclpy.topic_or_service_is_hidden": """
        studio.importable.rclpy_parts.validation: HIDDEN_TOPIC_PREFIX topic_or_service_is_hidden
    """,
    "rclpy.type_hash": "studio.importable.rclpy_parts.graph: TypeHash",
    "rclpy.type_support": """
        studio.importable.rclpy_parts.type_support: check_for_type_support
          check_is_valid_msg_type check_is_valid_srv_type
        studio.importable.rclpy_parts.exceptions: NoTypeSupportImportedException
    """,
    "rclpy.utilities": """
        studio.importable.rclpy_parts.processes: get_available_rmw_implementations
          get_rmw_implementation_identifier remove_ros_args timeout_sec_to_nsec
        studio.ros.node.context: Context get_default_context=default_context
        studio.ros.node.spinning: ok shutdown try_shutdown
        studio.ros.duration: S_TO_NS=NANOSECONDS
    """,
    "rclpy.validate_full_topic_name": """
        studio.importable.rclpy_parts.validation: validate_full_topic_name
        studio.importable.rclpy_parts.exceptions: InvalidTopicNameException
    """,
    "rclpy.validate_namespace": """
        studio.importable.rclpy_parts.validation: validate_namespace
        studio.importable.rclpy_parts.exceptions: InvalidNamespaceException
    """,
    "rclpy.validate_node_name": """
        studio.importable.rclpy_parts.validation: validate_node_name
        studio.importable.rclpy_parts.exceptions: InvalidNodeNameException
    """,
    "rclpy.validate_parameter_name": """
        studio.importable.rclpy_parts.validation: validate_parameter_name
    """,
    "rclpy.validate_topic_name": """
        studio.importable.rclpy_parts.validation: validate_topic_name
        studio.importable.rclpy_parts.exceptions: InvalidTopicNameException
    """,
    "rclpy.wait_for_message": """
        studio.importable.rclpy_parts.wait_for_message: wait_for_message
    """,
    "tf2_ros": """
        studio.tf2.broadcasters: TransformBroadcaster StaticTransformBroadcaster
        studio.tf2.buffer: Buffer
        studio.tf2.buffer_interface: BufferInterface TransformRegistration convert
          TypeException NotImplementedException
        studio.tf2.exceptions: TransformException LookupException ConnectivityException
          ExtrapolationException InvalidArgumentException TimeoutException
        studio.tf2.listener: TransformListener
        studio.importable.rclpy_parts.messages: TransformStamped
    """,
    "tf2_ros.buffer": "studio.tf2.buffer: Buffer",
    "tf2_ros.buffer_interface": """
        studio.tf2.buffer_interface: BufferInterface TransformRegistration convert
          TypeException NotImplementedException
    """,
    "tf2_ros.transform_broadcaster": "studio.tf2.broadcasters: TransformBroadcaster",
    "tf2_ros.transform_listener": "studio.tf2.listener: TransformListener",
    "tf2_ros.static_transform_broadcaster": """
        studio.tf2.broadcasters: StaticTransformBroadcaster
    """,
    "tf2_py": """
        studio.tf2.exceptions: TransformException LookupException ConnectivityException
          ExtrapolationException InvalidArgumentException TimeoutException
    """,
    "tf2_geometry_msgs": _TF2_GEOMETRY,
    "tf2_geometry_msgs.tf2_geometry_msgs": _TF2_GEOMETRY,
    "sensor_msgs_py": "",
    "sensor_msgs_py.point_cloud2": """
        studio.importable.point_cloud2: PointCloud2 PointField DUMMY_FIELD_PREFIX create_cloud
          create_cloud_xyz32 dtype_from_fields read_points read_points_list read_points_numpy
    """,
    "ament_index_python": """
        studio.importable.ament_index: PackageNotFoundError get_package_prefix
          get_package_share_directory get_package_share_path get_packages_with_prefixes
          get_resource get_resource_types get_resources has_resource get_search_paths
          get_package_share_path InvalidResourceNameError InvalidResourceTypeNameError
    """,
    "ament_index_python.packages": """
        studio.importable.ament_index: PackageNotFoundError get_package_prefix
          get_package_share_directory get_package_share_path get_packages_with_prefixes
    """,
    "ament_index_python.resources": """
        studio.importable.ament_index: get_resource get_resource_types get_resources has_resource
          InvalidResourceNameError InvalidResourceTypeNameError
    """,
    "ament_index_python.search_paths": "studio.importable.ament_index: get_search_paths",
    "rosidl_runtime_py": """
        studio.importable.rosidl_runtime: message_to_csv message_to_ordereddict message_to_yaml
          set_message_fields get_interface_path get_interface_packages get_interfaces
    """,
    "rosidl_runtime_py.convert": """
        studio.importable.rosidl_runtime: message_to_csv message_to_ordereddict message_to_yaml
          get_message_slot_types
    """,
    "rosidl_runtime_py.set_message": "studio.importable.rosidl_runtime: set_message_fields",
    "rosidl_runtime_py.utilities": """
        studio.importable.rosidl_runtime: get_message get_service get_action get_interface
          is_message is_service is_action
    """,
}
"""By module: sources, each with the names that it gives."""


ON_IMPORT: Final = {
    "tf2_ros": "studio.tf2.exceptions:name_as_tf2",
    "tf2_py": "studio.tf2.exceptions:name_as_tf2",
    "tf2_geometry_msgs": "studio.tf2.geometry:register",
}
"""What is called when a module is imported, without arguments."""


def _parsed(text: str) -> dict[str, str]:
    """Return by name where it is from, `module:attribute`."""
    found: dict[str, str] = {}
    source = ""
    for word in text.split():
        if word.endswith(":"):
            source = word[:-1]
        else:
            name, _, attribute = word.partition("=")
            found[name] = f"{source}:{attribute or name}"
    return found


MODULES: Final = {module: _parsed(text) for module, text in _TABLE.items()}
"""The names of each module, and where they are from."""
PACKAGES: Final = frozenset(
    module.rpartition(".")[0] for module in MODULES if "." in module
) | frozenset({"tf2_py"})
"""Modules that have others below them."""

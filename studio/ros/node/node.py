"""Node: a name on the wire with publishers, subscriptions, services, clients and timers."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from studio.ros import strictness
from studio.ros.duration import NANOSECONDS
from studio.ros.node.base import NodeBase
from studio.ros.node.clock import CLOCK_QOS, CLOCK_TOPIC, TimeSource
from studio.ros.node.context import default_context
from studio.ros.node.event_handler import CountEvent, events_of
from studio.ros.node.logger import LOG_TYPE, ROSOUT, LoggerServices, RosoutPublisher
from studio.ros.node.publisher import Publisher
from studio.ros.node.qos_overriding_options import override_qos
from studio.ros.node.samples import wants_info
from studio.ros.node.service import Service
from studio.ros.node.service_client import SERVICE_TIMEOUT_S, Client
from studio.ros.node.subscription import Subscription
from studio.ros.node.timer import Rate, Timer
from studio.ros.node.work import GuardCondition, ReentrantCallbackGroup
from studio.ros.parameters.files import read_overrides
from studio.ros.parameters.node_parameters import USE_SIM_TIME, NodeParameters
from studio.ros.parameters.parameter import DESCRIPTOR
from studio.ros.qos import (
    QoSProfile,
    qos_profile_rosout_default,
    qos_profile_services_default,
)
from studio.ros.tokens import EndpointKind
from studio.ros.types.classes import MessageValue
from studio.ros.types.library import ServiceType, check_is_type, check_same_type
from studio.ros.types.type_descriptions import (
    DESCRIPTION_SERVICE,
    DESCRIPTION_SERVICE_PARAMETER,
    DESCRIPTION_SERVICE_TYPE,
    fill_description,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from studio.ros.node.clock import Clock
    from studio.ros.node.context import Context
    from studio.ros.node.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
    from studio.ros.node.qos_overriding_options import QoSOverridingOptions
    from studio.ros.node.subscription import MessageCallback
    from studio.ros.node.work import CallbackGroup, Work
    from studio.ros.parameters.parameter import Parameter
    from studio.ros.types.library import ServiceKind


class Node(NodeBase, NodeParameters):
    """A node; `destroy_node` takes back all that is its own.

    Rooms above this one build on it by: `wire` (the session), `graph`, `context`, `add_work`
    (work of their own, carried out with the node's), `on_destroy` (to end before the node does),
    and `executor` (None until it spins). The names and arguments of the rest are rclpy's.
    """

    def __init__(  # noqa: PLR0913  # as in rclpy
        self,
        node_name: str,
        *,
        context: Context | None = None,
        cli_args: Sequence[str] | None = None,
        namespace: str | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        start_parameter_services: bool = True,
        parameter_overrides: Iterable[Parameter] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
        rosout_qos_profile: QoSProfile | int = qos_profile_rosout_default,
    ) -> None:
        joined = context or default_context()
        arguments = joined.arguments_of(node_name, cli_args, use_global=use_global_arguments)
        super().__init__(node_name, namespace or "/", joined, arguments)
        self._all_publishers: list[Publisher] = []
        self._rates: list[Rate] = []
        self._rosout: RosoutPublisher | None = None  # Ctrl-C may come before there is one
        self.on_destroy(self._destroy_publishers)
        if enable_rosout:
            types = self._wire.types
            publisher = self.create_publisher(types.message(LOG_TYPE), ROSOUT, rosout_qos_profile)
            self._rosout = RosoutPublisher(types, self.get_logger(), publisher.publish)
        self._time_source = TimeSource(self._clock, self._subscribe_clock)
        overrides = {one.name: one for one in parameter_overrides or ()}
        path = self.get_fully_qualified_name()
        given = read_overrides(arguments.files, arguments.values, path)
        overrides |= {one.name: one for one in given}
        self.open_parameters(
            self,
            self._wire.types,
            overrides=overrides.values(),
            allow_undeclared=allow_undeclared_parameters,
            declare_overrides=automatically_declare_parameters_from_overrides,
            serve=start_parameter_services,
        )
        self._describe_types()
        if enable_logger_service:
            self._serve_logger_levels()
        self._follow_sim_time(list(self.get_parameters([USE_SIM_TIME])))
        self.add_post_set_parameters_callback(self._follow_sim_time)

    @property
    def publishers(self) -> list[Publisher]:
        """Its publishers, that of /rosout among them."""
        return list(self._all_publishers)

    @property
    def subscriptions(self) -> list[Subscription]:
        """Its subscriptions."""
        return [one for one in self.all_work if isinstance(one, Subscription)]

    @property
    def services(self) -> list[Service]:
        """Its servers, those of parameters among them."""
        return [one for one in self.all_work if isinstance(one, Service)]

    @property
    def clients(self) -> list[Client]:
        """Its clients."""
        return [one for one in self.all_work if isinstance(one, Client)]

    @property
    def timers(self) -> list[Timer]:
        """Its timers."""
        return [one for one in self.all_work if isinstance(one, Timer)]

    @property
    def guards(self) -> list[GuardCondition]:
        """Its guard conditions."""
        return [one for one in self.all_work if isinstance(one, GuardCondition)]

    def create_publisher(  # noqa: PLR0913  # as in rclpy
        self,
        msg_type: type[MessageValue],
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: PublisherEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        publisher_class: type[Publisher] = Publisher,
    ) -> Publisher:
        """Make a publisher; the group is that of its event callbacks.

        Raises:
            RosNameError: The topic cannot be named so.
            OtherTypeError: The class is of another distribution than the wire.
            QosOverrideError: A parameter overrides the QoS with what it does not take.
            DestroyedError: The node was destroyed.
        """
        kind = EndpointKind.PUBLISHER
        check_is_type(msg_type, MessageValue, "message")
        type_name = check_same_type(self._wire.types, msg_type)
        qos = self._overridden(kind, topic, qos_profile, qos_overriding_options)
        endpoint = NodeBase.endpoint(self, kind, type_name, topic, qos)
        publisher = publisher_class(endpoint, msg_type)
        self._keep_publisher(publisher)
        group = callback_group or self._default_group
        self._add_events(publisher.events, events_of(event_callbacks, endpoint, group))
        return publisher

    def create_subscription(  # noqa: PLR0913  # as in rclpy
        self,
        msg_type: type[MessageValue],
        topic: str,
        callback: MessageCallback | None,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
    ) -> Subscription:
        """Make a subscription.

        Raises:
            RosNameError: The topic cannot be named so.
            OtherTypeError: The class is of another distribution than the wire.
            QosOverrideError: A parameter overrides the QoS with what it does not take.
            MessageCallbackError: The callback does not take a message.
            DestroyedError: The node was destroyed.
        """
        kind = EndpointKind.SUBSCRIPTION
        if callback is None and strictness.is_begun():  # it is no way to wait for messages there
            wants_info(topic, callback)
        check_is_type(msg_type, MessageValue, "message")
        type_name = check_same_type(self._wire.types, msg_type)
        qos = self._overridden(kind, topic, qos_profile, qos_overriding_options)
        endpoint = NodeBase.endpoint(self, kind, type_name, topic, qos)
        group = callback_group or self._default_group
        subscription = Subscription(endpoint, msg_type, callback, group, raw=raw)
        events = events_of(event_callbacks, endpoint, group)
        if event_callbacks is not None and event_callbacks.message_lost is not None:
            subscription.lost_event = CountEvent(event_callbacks.message_lost, group)
            events.append(subscription.lost_event)
        self.add_work(subscription)
        self._add_events(subscription.events, events)
        return subscription

    def create_service(
        self,
        srv_type: ServiceKind,
        srv_name: str,
        callback: Callable[[Any, Any], object],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Service:
        """Make a service's server.

        Raises:
            RosNameError: The service cannot be named so.
            DestroyedError: The node was destroyed.
        """
        check_is_type(srv_type, ServiceType, "service")
        endpoint = NodeBase.endpoint(
            self, EndpointKind.SERVICE, srv_type.name, srv_name, qos_profile
        )
        service = Service(endpoint, srv_type, callback, callback_group or self._default_group)
        service.given_name = srv_name
        self.add_work(service)
        return service

    def create_client(
        self,
        srv_type: ServiceKind,
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
        timeout_s: float = SERVICE_TIMEOUT_S,
    ) -> Client:
        """Make a service's client; a server that is silent for `timeout_s` is given up.

        Raises:
            RosNameError: The service cannot be named so.
            DestroyedError: The node was destroyed.
        """
        check_is_type(srv_type, ServiceType, "service")
        endpoint = NodeBase.endpoint(
            self, EndpointKind.CLIENT, srv_type.name, srv_name, qos_profile
        )
        group = callback_group or self._default_group
        client = Client(endpoint, srv_type, group, self, timeout_s)
        client.given_name = srv_name
        self.add_work(client)
        return client

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[[], object] | None,
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        *,
        autostart: bool = True,
    ) -> Timer:
        """Make a timer that calls back every so many seconds."""
        period_ns = int(float(timer_period_sec) * NANOSECONDS)
        group = callback_group or self._default_group
        timer = Timer(callback, period_ns, clock or self._clock, group, autostart=autostart)
        self.add_work(timer)
        return timer

    def create_guard_condition(
        self, callback: Callable[[], object], callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """Return work that any thread may trigger."""
        guard = GuardCondition(callback, callback_group or self._default_group)
        self.add_work(guard)
        return guard

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Make a rate of so many beats a second; it sleeps only while the node spins."""
        if frequency <= 0:
            raise ValueError("a rate is above 0 Hz")
        timer = self.create_timer(1.0 / frequency, None, clock=clock)
        rate = Rate(timer, self._context, self.get_logger(), self.destroy_timer)
        self._rates.append(rate)
        return rate

    def destroy_publisher(self, publisher: Publisher) -> bool:
        """Take back a publisher; whether it was the node's."""
        with self._lock:
            if publisher not in self._all_publishers:
                return False
            self._all_publishers.remove(publisher)
        for event in publisher.events:
            self.remove_work(event)
        publisher.destroy()
        return True

    def destroy_subscription(self, subscription: Subscription) -> bool:
        """Take back a subscription; whether it was the node's."""
        for event in subscription.events:
            self.remove_work(event)
        return self.remove_work(subscription)

    def destroy_service(self, service: Service) -> bool:
        """Take back a server; whether it was the node's."""
        return self.remove_work(service)

    def destroy_client(self, client: Client) -> bool:
        """Take back a client; whether it was the node's."""
        return self.remove_work(client)

    def destroy_timer(self, timer: Timer) -> bool:
        """Take back a timer; whether it was the node's."""
        return self.remove_work(timer)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        """Take back a guard; whether it was the node's."""
        return self.remove_work(guard)

    def destroy_rate(self, rate: Rate) -> bool:
        """Take back a rate; whether it was the node's."""
        if rate not in self._rates:
            return False
        self._rates.remove(rate)
        rate.destroy()
        return True

    def _keep_publisher(self, publisher: Publisher) -> None:
        with self._lock:
            is_late = self._destroyed
            if not is_late:
                self._all_publishers.append(publisher)
        if is_late:
            publisher.destroy()  # its token would outlive the node
            self._refuse_destroyed()

    def _add_events(self, known: list[Work], events: list[Work]) -> None:
        for event in events:
            known.append(event)
            self.add_work(event)

    def _describe_types(self) -> None:
        """Serve descriptions of types, as nodes do where keys carry hashes."""
        if not self._wire.profile.has_type_hash:
            return
        fixed = self._wire.types.message(DESCRIPTOR)(read_only=True)
        if self.declare_parameter(
            DESCRIPTION_SERVICE_PARAMETER, value=True, descriptor=fixed
        ).value:
            types = self._wire.types
            self.create_service(
                types.service(DESCRIPTION_SERVICE_TYPE),
                f"~/{DESCRIPTION_SERVICE}",
                partial(fill_description, types),
            )

    def _serve_logger_levels(self) -> None:
        """Let other nodes read and set from which level on loggers of this process write."""
        types, services = self._wire.types, LoggerServices(self._wire.types)
        for kind, callback in (("get", services.get_levels), ("set", services.set_levels)):
            service = types.service(f"rcl_interfaces/srv/{kind.title()}LoggerLevels")
            self.create_service(service, f"~/{kind}_logger_levels", callback)

    def _overridden(
        self,
        kind: EndpointKind,
        topic: str,
        qos: QoSProfile | int,
        options: QoSOverridingOptions | None,
    ) -> QoSProfile | int:
        if options is None:
            return qos
        endpoint = (kind, self.resolve_topic_name(topic))
        return override_qos(self, self._wire.types, endpoint, qos, options)

    def _subscribe_clock(self, callback: Callable[[MessageValue], None]) -> Callable[[], object]:
        # The clock goes on beside callbacks that wait for it, where there are threads for both.
        subscription = self.create_subscription(
            self._wire.types.message("rosgraph_msgs/msg/Clock"),
            CLOCK_TOPIC,
            callback,
            CLOCK_QOS,
            callback_group=ReentrantCallbackGroup(),
        )
        return partial(self.destroy_subscription, subscription)

    def _follow_sim_time(self, parameters: list[Parameter]) -> None:
        for parameter in parameters:
            if parameter.name == USE_SIM_TIME:
                self._time_source.ros_time_is_active = parameter.value is True

    def _destroy_publishers(self) -> None:
        """Destroy rates, /rosout and the other publishers, after everything else."""
        for rate in tuple(self._rates):
            self.destroy_rate(rate)
        if self._rosout is not None:
            self._rosout.stop()
        for publisher in tuple(self._all_publishers):
            self.destroy_publisher(publisher)

"""Node: a name on the wire with publishers, subscriptions, services, clients and timers."""

from __future__ import annotations

import threading
from functools import cached_property
from typing import TYPE_CHECKING, Any

from studio.errors import DestroyedError
from studio.ros.describing import START_PARAMETER, serve_descriptions
from studio.ros.duration import NANOSECONDS
from studio.ros.names import as_namespace, check_node_name, expand
from studio.ros.node.clock import Clock
from studio.ros.node.context import default_context
from studio.ros.node.drain import Source
from studio.ros.node.endpoint import Endpoint, endpoint_of
from studio.ros.node.logger import Logger, get_logger
from studio.ros.node.publisher import Publisher
from studio.ros.node.rate import Rate
from studio.ros.node.rosout import RosoutPublisher
from studio.ros.node.service import Service
from studio.ros.node.service_client import SERVICE_TIMEOUT_S, Client
from studio.ros.node.subscription import Subscription
from studio.ros.node.time import ClockType
from studio.ros.node.timer import Timer
from studio.ros.node.work import MutuallyExclusiveCallbackGroup
from studio.ros.parameters.messages import DESCRIPTOR
from studio.ros.parameters.of_node import NodeParameters
from studio.ros.qos import QoSProfile, as_profile, qos_profile_services_default
from studio.ros.tokens import EndpointKind, NodeToken
from studio.ros.types.classes import MessageValue, definition_of
from studio.ros.wire.door import declare_token

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from studio.ros.graph.graph import Graph
    from studio.ros.node.context import Context
    from studio.ros.node.executor import Executor
    from studio.ros.node.kinds import ServiceKind
    from studio.ros.node.work import CallbackGroup, Work
    from studio.ros.parameters.parameter import Parameter
    from studio.ros.wire.session import WireSession


class Node(NodeParameters):
    """One node; `destroy_node` takes back all that is its own.

    Rooms above this one build on it by: `wire` (the session), `context`, `add_work` (work of
    their own, carried out with the node's), `on_destroy` (to end before the node does), and
    `executor` (None until it spins). The names and arguments of the rest are rclpy's.
    """

    def __init__(  # noqa: PLR0913  # as in rclpy
        self,
        node_name: str,
        *,
        context: Context | None = None,
        namespace: str = "/",
        enable_rosout: bool = True,
        start_parameter_services: bool = True,
        parameter_overrides: Iterable[Parameter] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
    ) -> None:
        self._context = joined = context or default_context()
        self._wire: WireSession = joined.wire
        self._executor: Executor | None = None
        self._default_group: CallbackGroup = MutuallyExclusiveCallbackGroup()
        self._lock = threading.RLock()
        self._all_work: list[Work] = []
        self._all_publishers: list[Publisher] = []
        self._rates: list[Rate] = []
        self._ends: list[Callable[[], None]] = []
        self._destroyed = False
        self._clock = Clock(clock_type=ClockType.ROS_TIME)
        name, space = check_node_name(node_name), as_namespace(namespace)
        self._token = NodeToken(
            self._wire.domain, self._wire.zid, self._wire.next_id(), space, name
        )
        self._shown = declare_token(self._wire.zenoh, str(self._token))
        self._rosout = RosoutPublisher(self) if enable_rosout else None
        self.open_parameters(
            self,
            self._wire.types,
            overrides=parameter_overrides or (),
            allow_undeclared=allow_undeclared_parameters,
            declare_overrides=automatically_declare_parameters_from_overrides,
            serve=start_parameter_services,
        )
        self._describe_types()
        joined.on_close(self.destroy_node)

    # Students name attributes of their nodes as they like: what is cached here they may hide.
    @cached_property
    def wire(self) -> WireSession:
        """The session that it shares with the other nodes of the process."""
        return self._wire

    @cached_property
    def context(self) -> Context:
        """What it shares with the other nodes of the process."""
        return self._context

    @property
    def graph(self) -> Graph:
        """Who is there, for all nodes of the process."""
        return self._context.graph

    @property
    def token(self) -> NodeToken:
        """How it is shown on the wire."""
        return self._token

    @property
    def executor(self) -> Executor | None:
        """Who carries out its work, None until it spins."""
        return self._executor

    @executor.setter
    def executor(self, executor: Executor | None) -> None:
        before, self._executor = self._executor, executor
        if before is not None and before is not executor:
            before.remove_node(self)

    @property
    def default_callback_group(self) -> CallbackGroup:
        """The group of all that names none: one piece at a time."""
        return self._default_group

    @property
    def all_work(self) -> list[Work]:
        """What it has to do now and then: subscriptions, timers, services, clients and others."""
        with self._lock:
            return list(self._all_work)

    def get_name(self) -> str:
        """Give its name without the namespace."""
        return self._token.name

    def get_namespace(self) -> str:
        """Give its namespace, `/` or `/ns`."""
        return self._token.namespace

    def get_fully_qualified_name(self) -> str:
        """Give namespace and name, `/ns/name`."""
        return self._token.path

    def get_logger(self) -> Logger:
        """Give its logger, named `ns.name`."""
        return get_logger(self._token.path.strip("/").replace("/", "."))

    def get_clock(self) -> Clock:
        """Give its clock, which /clock tells when `use_sim_time` is set."""
        return self._clock

    def resolve_topic_name(self, topic: str) -> str:
        """Give the full name of a topic of this node."""
        return self._full_name(topic)

    resolve_service_name = resolve_topic_name

    def create_publisher(
        self,
        msg_type: type[MessageValue],
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        publisher_class: type[Publisher] = Publisher,
    ) -> Publisher:
        """Make a publisher.

        Raises:
            RosNameError: The topic cannot be named so.
            DestroyedError: The node was destroyed.
        """
        endpoint = self._endpoint(EndpointKind.PUBLISHER, msg_type, topic, as_profile(qos_profile))
        publisher = publisher_class(endpoint, msg_type)
        with self._lock:
            self._all_publishers.append(publisher)
        return publisher

    def create_subscription(
        self,
        msg_type: type[MessageValue],
        topic: str,
        callback: Callable[..., object] | None,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        raw: bool = False,
    ) -> Subscription:
        """Make a subscription.

        Raises:
            RosNameError: The topic cannot be named so.
            DestroyedError: The node was destroyed.
        """
        endpoint = self._endpoint(
            EndpointKind.SUBSCRIPTION, msg_type, topic, as_profile(qos_profile)
        )
        group = callback_group or self._default_group
        subscription = Subscription(endpoint, msg_type, callback, group, raw=raw)
        self.add_work(subscription)
        self._context.drain.add(subscription)
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
        endpoint = self._service_endpoint(EndpointKind.SERVICE, srv_type, srv_name, qos_profile)
        service = Service(endpoint, srv_type, callback, callback_group or self._default_group)
        self.add_work(service)
        self._context.drain.add(service)
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
        endpoint = self._service_endpoint(EndpointKind.CLIENT, srv_type, srv_name, qos_profile)
        group = callback_group or self._default_group
        client = Client(endpoint, srv_type, group, self, timeout_s)
        self.add_work(client)
        self._context.drain.add(client)
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

    def create_rate(self, frequency: float) -> Rate:
        """Make a rate of so many beats a second; it sleeps only while the node spins."""
        rate = Rate(self, frequency)
        self._rates.append(rate)
        return rate

    def add_work(self, work: Work) -> None:
        """Have work of any kind carried out with the node's own; it is destroyed with the node.

        Raises:
            DestroyedError: The node was destroyed.
        """
        with self._lock:
            self._refuse_destroyed()
            self._all_work.append(work)
        work.home = self
        executor = self._executor
        if executor is not None:
            executor.adopt(work)

    def remove_work(self, work: Work) -> bool:
        """Destroy a piece of work; whether it was the node's."""
        with self._lock:
            if work not in self._all_work:
                return False
            self._all_work.remove(work)
        work.home = None
        executor = self._executor
        if executor is not None:
            executor.forget(work)
        if isinstance(work, Source):
            self._context.forget_source(work)
        work.destroy()
        return True

    def announce(self, work: Work) -> None:
        """Tell whoever spins the node that work is ready; from any thread."""
        executor = self._executor
        if executor is not None:
            executor.announce(work)

    def on_destroy(self, callback: Callable[[], None]) -> None:
        """Call back once before the node's own things are taken back."""
        with self._lock:
            self._ends.append(callback)

    def destroy_publisher(self, publisher: Publisher) -> bool:
        """Take back a publisher; whether it was the node's."""
        with self._lock:
            if publisher not in self._all_publishers:
                return False
            self._all_publishers.remove(publisher)
        publisher.destroy()
        return True

    def destroy_subscription(self, subscription: Subscription) -> bool:
        """Take back a subscription; whether it was the node's."""
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

    def destroy_rate(self, rate: Rate) -> bool:
        """Take back a rate; whether it was the node's."""
        if rate not in self._rates:
            return False
        self._rates.remove(rate)
        rate.destroy()
        return True

    def destroy_node(self) -> None:
        """Take back all that is its own, and then itself; again is harmless."""
        with self._lock:
            if self._destroyed:
                return
            self._destroyed = True
            ends, self._ends = self._ends, []
        for end in ends:
            end()
        for rate in tuple(self._rates):
            self.destroy_rate(rate)
        for work in self.all_work:
            self.remove_work(work)
        if self._executor is not None:
            self._executor.remove_node(self)
        if self._rosout is not None:
            self._rosout.stop()
        for publisher in tuple(self._all_publishers):
            self.destroy_publisher(publisher)
        if not self._wire.zenoh.is_closed():
            self._shown.undeclare()

    def _describe_types(self) -> None:
        """Tell others what types are made of, as nodes do where keys carry hashes."""
        if not self._wire.profile.has_type_hash:
            return
        fixed = self._wire.types.message(DESCRIPTOR)(read_only=True)
        if self.declare_parameter(START_PARAMETER, value=True, descriptor=fixed).value:
            serve_descriptions(self, self._wire.types)

    def _full_name(self, name: str) -> str:
        return expand(name, self._token.namespace, self._token.name)

    def _endpoint(
        self, kind: EndpointKind, msg_type: type[MessageValue], topic: str, qos: QoSProfile
    ) -> Endpoint:
        return self._endpoint_named(kind, definition_of(msg_type).name, topic, qos)

    def _service_endpoint(
        self, kind: EndpointKind, srv_type: ServiceKind, name: str, qos: QoSProfile
    ) -> Endpoint:
        return self._endpoint_named(kind, srv_type.name, name, as_profile(qos))

    def _endpoint_named(
        self, kind: EndpointKind, type_name: str, name: str, qos: QoSProfile
    ) -> Endpoint:
        self._refuse_destroyed()
        named = (self._full_name(name), type_name, self._wire.types.hash_of(type_name))
        return endpoint_of(self._wire, self._token, kind, named, qos)

    def _refuse_destroyed(self) -> None:
        if self._destroyed:
            raise DestroyedError(f"node {self._token.path}")

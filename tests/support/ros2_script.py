"""A process of real ROS 2 nodes (rclpy) that does what lines of JSON on its input ask for.

It runs with the Python of the real ROS 2, and imports nothing of the studio. It says a line of JSON
for everything that it hears and does: `{"what": "done", "id": 3, "answer": ...}`.
"""
# pyright: basic, reportMissingImports=false, reportAttributeAccessIssue=false
# pyright: reportOptionalMemberAccess=false
# ruff: noqa: ANN001, ANN003, ANN202, ANN204, T201

from __future__ import annotations

import ctypes
import json
import os
import sys
import threading
import time

import rclpy
from action_msgs.msg import GoalStatus
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from rcl_interfaces.msg import Log
from rclpy.action import ActionClient
from rclpy.executors import MultiThreadedExecutor
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import String, UInt8MultiArray

PATIENCE_S = 60
DEPTH = 3


_saying = threading.Lock()


def say(what, **values):
    with _saying:
        print(json.dumps({"what": what, **values}), flush=True)


def qos_of(text):
    """`reliable transient_local` as a profile."""
    reliability, durability = text.split()
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=DEPTH,
        reliability=ReliabilityPolicy[reliability.upper()],
        durability=DurabilityPolicy[durability.upper()],
    )


def wait(future):
    """Wait for a future that the spinning thread sets."""
    there = threading.Event()
    future.add_done_callback(lambda _: there.set())
    if not there.wait(PATIENCE_S):
        raise TimeoutError(future)
    return future.result()


class TypeSupport(ctypes.Structure):
    """`rosidl_message_type_support_t`."""

    _fields_ = (
        ("identifier", ctypes.c_char_p),
        ("data", ctypes.c_void_p),
        ("of", ctypes.c_void_p),
        ("hash_of", ctypes.c_void_p),
        ("description_of", ctypes.c_void_p),
        ("sources_of", ctypes.c_void_p),
    )


class Callbacks(ctypes.Structure):
    """`message_type_support_callbacks_t`: names, and functions that stay as they are."""

    _fields_ = (
        ("namespace", ctypes.c_char_p),
        ("name", ctypes.c_char_p),
        ("functions", ctypes.c_void_p * 8),
    )


def unread_type(type_name, type_hash):
    """A message class that is not built here: the bytes of its messages can be received.

    It is the class String under another name and hash. Of these the middleware makes its keys; what
    is in a message only matters to those who read or write one.
    """
    find = ctypes.pythonapi.PyCapsule_GetPointer
    find.restype, find.argtypes = ctypes.c_void_p, (ctypes.py_object, ctypes.c_char_p)
    name_of = ctypes.pythonapi.PyCapsule_GetName
    name_of.restype, name_of.argtypes = ctypes.c_char_p, (ctypes.py_object,)
    make = ctypes.pythonapi.PyCapsule_New
    make.restype = ctypes.py_object
    make.argtypes = (ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p)
    lookup = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_void_p, ctypes.c_char_p)
    hashing = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_void_p)

    String.__class__.__import_type_support__()
    capsule = String.__class__._TYPE_SUPPORT
    capsule_name = name_of(capsule)
    outer = TypeSupport.from_address(find(capsule, capsule_name))
    wanted = b"rosidl_typesupport_fastrtps_c"
    inner = TypeSupport.from_address(lookup(outer.of)(ctypes.addressof(outer), wanted))
    package, kind, name = (part.encode() for part in type_name.split("/"))
    callbacks = Callbacks.from_buffer_copy(Callbacks.from_address(inner.data))
    callbacks.namespace, callbacks.name = package + b"::" + kind, name
    made = TypeSupport.from_buffer_copy(inner)
    digest = bytes.fromhex(type_hash.removeprefix("RIHS01_"))
    hashed = ctypes.create_string_buffer(b"\x01" + digest, 33)
    functions = (
        lookup(lambda _, which: ctypes.addressof(made) if which == wanted else None),
        hashing(lambda _: ctypes.addressof(hashed)),
    )
    made.data = ctypes.addressof(callbacks)
    made.of, made.hash_of = (ctypes.cast(one, ctypes.c_void_p).value for one in functions)
    KEPT.extend((made, callbacks, hashed, *functions))
    held = make(ctypes.addressof(made), capsule_name, None)
    kind_of_class = type("UnreadType", (String.__class__,), {"_TYPE_SUPPORT": held})
    return kind_of_class(name.decode(), (String,), {})


KEPT = []
"""What C points to."""


class Managed(LifecycleNode):
    """A managed node: it refuses to be cleaned up."""

    def on_configure(self, state):
        say("transition", name="configure", of=state.label)
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        say("transition", name="activate", of=state.label)
        return super().on_activate(state)

    def on_cleanup(self, state):
        say("transition", name="cleanup", of=state.label)
        return TransitionCallbackReturn.FAILURE


class Process:
    """The nodes, and what they are asked to do."""

    def __init__(self):
        rclpy.init()
        self.node = Node("real")
        self.executor = MultiThreadedExecutor(4)
        self.executor.add_node(self.node)
        threading.Thread(target=self.executor.spin, daemon=True).start()
        self.publishers = {}
        self.kept = []
        self.cancels = threading.Event()

    def run(self):
        say("ready")
        for line in sys.stdin:
            asked = json.loads(line)
            number, do = asked.pop("id"), asked.pop("do")
            try:
                say("done", id=number, answer=getattr(self, do)(**asked))
            except Exception as error:  # noqa: BLE001  # told to the test
                say("done", id=number, error=repr(error))

    def node_in(self, name, namespace="/", enclave=None, domain=None):
        """Make a node; with an enclave or a domain, in a context of its own."""
        words = ["--ros-args", "--enclave", enclave] if enclave else []
        context = rclpy.Context()
        context.init(words, domain_id=domain)
        self.kept.append((context, Node(name, namespace=namespace, context=context)))

    def managed(self, name):
        node = Managed(name)
        self.executor.add_node(node)
        self.kept.append(node)

    def subscribe(self, topic, qos):
        def hear(message, info):
            say("message", topic=topic, qos=qos, data=message.data,
                sequence=info["publication_sequence_number"])  # fmt: skip

        self.kept.append(self.node.create_subscription(String, topic, hear, qos_of(qos)))

    def hear_raw(self, topic, type_name, type_hash):
        """Receive the bytes of a type that is not built here."""

        def hear(payload):
            say("raw", topic=topic, payload=payload.hex())

        kind = unread_type(type_name, type_hash)
        self.kept.append(self.node.create_subscription(kind, topic, hear, 10, raw=True))

    def publish_raw(self, topic, type_name, type_hash, payload):
        """Publish the bytes of a type that is not built here, once somebody subscribes to it."""
        publisher = self.node.create_publisher(unread_type(type_name, type_hash), topic, 10)
        self.kept.append(publisher)
        end_s = time.monotonic() + PATIENCE_S
        while not publisher.get_subscription_count() and time.monotonic() < end_s:
            time.sleep(0.05)
        publisher.publish(bytes.fromhex(payload))

    def publish(self, topic, qos, data, readers=0):
        """Publish texts, once so many subscriptions are there."""
        if topic not in self.publishers:
            self.publishers[topic] = self.node.create_publisher(String, topic, qos_of(qos))
        publisher = self.publishers[topic]
        end_s = time.monotonic() + PATIENCE_S
        while publisher.get_subscription_count() < readers:
            if time.monotonic() > end_s:
                raise TimeoutError(topic)
            time.sleep(0.01)
        for text in data:
            publisher.publish(String(data=text))

    def subscribe_large(self, topic):
        def hear(message):
            data = bytes(message.data)
            say("large", topic=topic, size=len(data), ends=[data[0], data[-1]])

        self.kept.append(self.node.create_subscription(UInt8MultiArray, topic, hear, 3))

    def publish_large(self, topic, size):
        publisher = self.node.create_publisher(UInt8MultiArray, topic, 3)
        self.kept.append(publisher)
        data = UInt8MultiArray(data=bytes([7]) + bytes(size - 2) + bytes([9]))
        # Several, in case the other end is told of it a moment later.
        self.large = self.node.create_timer(0.3, lambda: publisher.publish(data))

    def end_large(self):
        self.node.destroy_timer(self.large)

    def hear_log(self):
        def hear(message):
            level = message.level
            level = level if isinstance(level, int) else int.from_bytes(level, "little")
            say("log", name=message.name, level=level, text=message.msg)

        latched = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.kept.append(self.node.create_subscription(Log, "/rosout", hear, latched))

    def log(self, text):
        self.node.get_logger().warning(text)

    def call(self, service, a, b):
        client = self.node.create_client(AddTwoInts, service)
        if not client.wait_for_service(PATIENCE_S):
            return None
        return wait(client.call_async(AddTwoInts.Request(a=a, b=b))).sum

    def goal(self, action, order, cancels=False):
        """Send a goal, and cancel it at the first feedback if told to."""
        client = ActionClient(self.node, Fibonacci, action)
        if not client.wait_for_server(PATIENCE_S):
            return None
        heard = []
        begun = threading.Event()

        def hear(message):
            heard.append(list(message.feedback.sequence))
            begun.set()

        goal = wait(client.send_goal_async(Fibonacci.Goal(order=order), feedback_callback=hear))
        if not goal.accepted:
            return {"accepted": False}
        code = None
        if cancels:
            begun.wait(PATIENCE_S)
            code = wait(goal.cancel_goal_async()).return_code
        result = wait(goal.get_result_async())
        return {
            "accepted": True,
            "code": code,
            "status": {
                GoalStatus.STATUS_SUCCEEDED: "succeeded",
                GoalStatus.STATUS_CANCELED: "canceled",
                GoalStatus.STATUS_ABORTED: "aborted",
            }[result.status],
            "sequence": list(result.result.sequence),
            "feedback": len(heard),
        }

    def parameters(self, node, values, names):
        """Set values one by one, then get names; the reasons and values."""
        client = AsyncParameterClient(self.node, node)
        if not client.wait_for_services(PATIENCE_S):
            return None
        reasons = {}
        for name, value in values.items():
            [result] = wait(client.set_parameters([Parameter(name, value=value)])).results
            reasons[name] = None if result.successful else result.reason
        got = [parameter_value_to_python(one) for one in wait(client.get_parameters(names)).values]
        return {
            "listed": sorted(wait(client.list_parameters()).result.names),
            "reasons": reasons,
            "values": [one.tolist() if hasattr(one, "tolist") else one for one in got],
        }

    def graph(self):
        """Nodes with their enclaves, and topics and services with their types."""
        node = self.node
        return {
            "nodes": [
                [f"{namespace.rstrip('/')}/{name}", enclave]
                for name, namespace, enclave in node.get_node_names_and_namespaces_with_enclaves()
            ],
            "topics": dict(node.get_topic_names_and_types()),
            "services": dict(node.get_service_names_and_types()),
        }

    def ends(self, topic):
        """What it sees of the publishers of a topic."""
        return [
            {
                "node": info.node_name,
                "type": info.topic_type,
                "hash": str(info.topic_type_hash),
                "reliability": info.qos_profile.reliability.name,
                "durability": info.qos_profile.durability.name,
                "depth": info.qos_profile.depth,
                "gid": bytes(info.endpoint_gid).hex(),
            }
            for info in self.node.get_publishers_info_by_topic(topic)
        ]


if __name__ == "__main__":
    Process().run()
    os._exit(0)

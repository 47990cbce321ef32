"""Small programs as students write them, for `studio run` and for the real rclpy alike.

Each prints what can be observed, in an order that does not depend on chance. They use only types
that both have.
"""

from __future__ import annotations

from typing import Final

from tests.support.rclpy_scripts_of_nodes import SCRIPTS as OF_NODES
from tests.support.rclpy_scripts_of_topics import SCRIPTS as OF_TOPICS

_BEGIN: Final = """\
import sys, time, threading
import rclpy
from rclpy.node import Node
from std_msgs.msg import String, Int32, Header
"""

SCRIPTS: Final[dict[str, str]] = {
    **OF_NODES,
    **OF_TOPICS,
    "an exit with a text": """
sys.exit('leaving with a text')
""",
    "init twice": """
rclpy.init()
try:
    rclpy.init()
except RuntimeError as error:
    print(type(error).__name__)
rclpy.shutdown()
try:
    rclpy.shutdown()
except RuntimeError as error:
    print(type(error).__name__, error)
print(rclpy.try_shutdown())
""",
    "a node without init": """
Node('early')
""",
    "names that are not allowed": """
rclpy.init()
from rclpy.exceptions import InvalidTopicNameException, NameValidationException
for name in ('bad name', '1st', ''):
    try:
        Node(name)
    except Exception as error:
        print(type(error).__name__, isinstance(error, ValueError))
node = Node('good')
for topic in ('bad topic', '/a//b', 'a/'):
    try:
        node.create_publisher(String, topic, 10)
    except InvalidTopicNameException as error:
        print(type(error).__name__, isinstance(error, NameValidationException))
""",
    "QoS": """
from rclpy.qos import (QoSProfile, ReliabilityPolicy, DurabilityPolicy, HistoryPolicy,
    QoSReliabilityPolicy, qos_profile_sensor_data, QoSPresetProfiles, InvalidQoSProfileException)
q = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT,
               durability=DurabilityPolicy.TRANSIENT_LOCAL)
print(q.depth, q.reliability.name, q.durability.name, q.history.name)
print(qos_profile_sensor_data.depth, qos_profile_sensor_data.reliability.name)
print(QoSReliabilityPolicy is ReliabilityPolicy, QoSPresetProfiles.SENSOR_DATA.value.depth)
print(QoSPresetProfiles.get_from_short_key('services_default').depth)
for make in (lambda: QoSProfile(), lambda: QoSProfile(history=HistoryPolicy.KEEP_LAST),
             lambda: QoSProfile(deepth=1)):
    try:
        make()
    except Exception as error:
        print(type(error).__name__)
rclpy.init()
node = Node('qos')
pub = node.create_publisher(String, 'latched', QoSProfile(depth=1,
    durability=DurabilityPolicy.TRANSIENT_LOCAL))
pub.publish(String(data='kept'))
heard = []
node.create_subscription(String, 'latched', heard.append, QoSProfile(depth=1,
    durability=DurabilityPolicy.TRANSIENT_LOCAL))
while not heard:
    rclpy.spin_once(node, timeout_sec=0.1)
print(heard[0].data, pub.topic_name)
try:
    node.create_subscription(String, 'x', heard.append, 'ten')
except TypeError as error:
    print(type(error).__name__)
""",
    "messages": """
m = String(data='x')
print(m, m == String(data='x'), String.get_fields_and_field_types())
try:
    m.nope = 1
except AttributeError as error:
    print(error)
try:
    String('x')
except TypeError as error:
    print(type(error).__name__)
h = Header(frame_id='base')
h.stamp.sec = 5
print(h)
from std_msgs.msg import UInt8MultiArray, MultiArrayDimension
a = UInt8MultiArray(data=[1, 2])
a.data.append(3)
a.layout.dim.append(MultiArrayDimension(label='n', size=3))
print(a, len(a.data), list(a.data))
from rclpy.serialization import serialize_message, deserialize_message
data = serialize_message(a)
print(data.hex(), deserialize_message(data, UInt8MultiArray) == a)
from example_interfaces.srv import AddTwoInts
print(AddTwoInts.Request(a=1), AddTwoInts.Response())
from action_msgs.msg import GoalStatus
print(GoalStatus.STATUS_SUCCEEDED)
from geometry_msgs.msg import Twist
t = Twist()
t.linear.x = 2.0
print(t)
""",
    "times and durations": """
from rclpy.time import Time
from rclpy.duration import Duration
from rclpy.clock import Clock, ClockType, ROSClock
t = Time(seconds=5, nanoseconds=7)
print(t.nanoseconds, t.seconds_nanoseconds(), (t + Duration(seconds=1)).nanoseconds)
print((Time(seconds=9) - Time(seconds=4)).nanoseconds, Time(seconds=1) < Time(seconds=2))
print(t.to_msg(), Time.from_msg(t.to_msg()).nanoseconds, Duration(seconds=1.5).to_msg())
print(repr(t), repr(Duration(seconds=2)), str(Duration(seconds=2)))
for bad in (lambda: Time(seconds=-1), lambda: t < Time(seconds=1, clock_type=ClockType.ROS_TIME),
            lambda: t + t):
    try:
        bad()
    except Exception as error:
        print(type(error).__name__)
rclpy.init()
node = Node('clock')
print(node.get_clock().clock_type, Clock().clock_type, ROSClock().clock_type)
print(abs(node.get_clock().now().nanoseconds - time.time_ns()) < 10**9)
""",
    "an action with feedback and result": """
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from example_interfaces.action import Fibonacci
from action_msgs.msg import GoalStatus
rclpy.init()
node = Node('fib')
def execute(goal_handle):
    feedback = Fibonacci.Feedback()
    feedback.sequence = [0, 1]
    for i in range(1, goal_handle.request.order):
        feedback.sequence.append(feedback.sequence[i] + feedback.sequence[i - 1])
        goal_handle.publish_feedback(feedback)
    goal_handle.succeed()
    result = Fibonacci.Result()
    result.sequence = feedback.sequence
    return result
def decide(request):
    return GoalResponse.REJECT if request.order > 10 else GoalResponse.ACCEPT
server = ActionServer(node, Fibonacci, 'fibonacci', execute, goal_callback=decide)
client = ActionClient(node, Fibonacci, 'fibonacci')
print(client.wait_for_server(timeout_sec=5.0))
heard = []
future = client.send_goal_async(Fibonacci.Goal(order=5),
                                feedback_callback=lambda f: heard.append(list(f.feedback.sequence)))
rclpy.spin_until_future_complete(node, future)
handle = future.result()
print(handle.accepted)
got = handle.get_result_async()
rclpy.spin_until_future_complete(node, got)
print(got.result().status == GoalStatus.STATUS_SUCCEEDED, list(got.result().result.sequence))
print(heard == [[0, 1, 1], [0, 1, 1, 2], [0, 1, 1, 2, 3], [0, 1, 1, 2, 3, 5]][:len(heard)])
future = client.send_goal_async(Fibonacci.Goal(order=50))
rclpy.spin_until_future_complete(node, future)
print(future.result().accepted)
""",
    "asyncio.sleep in an execute callback": """
import asyncio
from rclpy.action import ActionClient, ActionServer
from example_interfaces.action import Fibonacci
rclpy.init()
node = Node('fib')
async def execute(goal_handle):
    await asyncio.sleep(0.1)
    goal_handle.succeed()
    return Fibonacci.Result()
server = ActionServer(node, Fibonacci, 'fibonacci3', execute)
client = ActionClient(node, Fibonacci, 'fibonacci3')
client.wait_for_server()
future = client.send_goal_async(Fibonacci.Goal(order=1))
rclpy.spin_until_future_complete(node, future)
got = future.result().get_result_async()
try:
    rclpy.spin_until_future_complete(node, got, timeout_sec=2)
    print(got.result().status)
except BaseException as error:
    print(type(error).__name__)
""",
    "an async callback that awaits a service": """
from example_interfaces.srv import AddTwoInts
rclpy.init()
node = Node('asyncs')
from rclpy.callback_groups import ReentrantCallbackGroup
group = ReentrantCallbackGroup()
def add(request, response):
    response.sum = request.a + request.b
    return response
node.create_service(AddTwoInts, 'awaited', add, callback_group=group)
client = node.create_client(AddTwoInts, 'awaited', callback_group=group)
client.wait_for_service(5)
sums = []
async def ask():
    timer.cancel()
    answer = await client.call_async(AddTwoInts.Request(a=2, b=3))
    sums.append(answer.sum)
timer = node.create_timer(0.01, ask, callback_group=group)
while not sums:
    rclpy.spin_once(node, timeout_sec=0.1)
print(sums)
""",
    "the logger": """
rclpy.init()
node = Node('logs', namespace='a')
log = node.get_logger()
log.debug('not seen')
log.info('info'); log.warn('warn'); log.warning('warning'); log.error('error'); log.fatal('fatal')
log.get_child('kid').info('of a child')
for i in range(3):
    log.info(f'once {i}', once=True)
for i in range(3):
    log.info(f'skip {i}', skip_first=True)
for i in range(3):
    log.info(f'throttled {i}', throttle_duration_sec=10.0)
from rclpy.logging import LoggingSeverity, get_logger, set_logger_level
log.set_level(LoggingSeverity.DEBUG)
log.debug('seen')
print(log.name, log.get_effective_level().name, log.is_enabled_for(LoggingSeverity.DEBUG))
set_logger_level('free', LoggingSeverity.ERROR)
get_logger('free').warning('not seen')
for bad in (lambda: log.info(5), lambda: log.info('x', nonsense=1)):
    try:
        bad()
    except TypeError as error:
        print(type(error).__name__)
""",
    "use after the end": """
rclpy.init()
node = Node('ended')
pub = node.create_publisher(String, 'topic', 10)
node.destroy_node()
for late in (lambda: pub.publish(String()), lambda: node.create_publisher(String, 'topic', 10)):
    try:
        late()
    except Exception as error:
        print(type(error).__name__)
""",
    "wrong types": """
rclpy.init()
node = Node('wrong')
pub = node.create_publisher(String, 'topic', 10)
for bad in (lambda: pub.publish(Int32()), lambda: pub.publish('hello'),
            lambda: node.create_publisher(String, 'topic'), lambda: node.create_timer('x', None)):
    try:
        bad()
    except Exception as error:
        print(type(error).__name__)
""",
    "the graph": """
rclpy.init()
node = Node('seen', namespace='/space')
pub = node.create_publisher(String, 'topic', 10)
sub = node.create_subscription(String, 'topic', print, 10)
end = time.monotonic() + 5
while node.count_subscribers('topic') < 1 and time.monotonic() < end:
    time.sleep(0.05)
print(node.count_publishers('topic'), node.count_subscribers('topic'))
print(('seen', '/space') in node.get_node_names_and_namespaces())
print([t for t in node.get_topic_names_and_types() if t[0] == '/space/topic'])
[info] = node.get_publishers_info_by_topic('/space/topic')
print(info.node_name, info.node_namespace, info.topic_type, info.qos_profile.reliability.name)
print([t for t in node.get_publisher_names_and_types_by_node('seen', '/space') if 'topic' in t[0]])
try:
    node.get_publisher_names_and_types_by_node('nobody', '/')
except Exception as error:
    print(type(error).__name__)
print(pub.get_subscription_count(), bool(list(node.publishers)), bool(list(node.subscriptions)))
""",
    "a lifecycle node": """
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn, LifecycleState
class Managed(LifecycleNode):
    def on_configure(self, state):
        print('configure', state.label)
        self.pub = self.create_lifecycle_publisher(String, 'managed', 10)
        return TransitionCallbackReturn.SUCCESS
    def on_activate(self, state):
        print('activate', state.label)
        return super().on_activate(state)
    def on_shutdown(self, state):
        print('shutdown', state.label)
        return TransitionCallbackReturn.SUCCESS
rclpy.init()
node = Managed('managed')
print(node.trigger_configure().name, node.trigger_activate().name)
print(node.pub.is_activated)
print(node.trigger_deactivate().name, node.trigger_shutdown().name)
""",
    "wait_for_message": """
from rclpy.wait_for_message import wait_for_message
rclpy.init()
node = Node('waiter')
other = Node('sender')
pub = other.create_publisher(String, 'awaited_topic', 10)
stop = threading.Event()
def send():
    while not stop.is_set():
        pub.publish(String(data='there'))
        time.sleep(0.05)
thread = threading.Thread(target=send)
thread.start()
print(wait_for_message(String, node, 'awaited_topic', time_to_wait=5))
stop.set()
thread.join()
print(wait_for_message(String, node, 'silent_topic', time_to_wait=0.2))
""",
    "a parameter client and the events of parameters": """
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.parameter_event_handler import ParameterEventHandler
rclpy.init()
node = Node('owner')
node.declare_parameter('speed', 1.0)
asker = Node('asker')
client = AsyncParameterClient(asker, 'owner')
from rclpy.executors import SingleThreadedExecutor
executor = SingleThreadedExecutor()
executor.add_node(node)
executor.add_node(asker)
handler = ParameterEventHandler(asker)
heard = []
handler.add_parameter_callback('speed', '/owner', lambda p: heard.append(p.value.double_value))
def wait(future):
    executor.spin_until_future_complete(future, timeout_sec=5)
    return future.result()
end = time.monotonic() + 5
while not client.services_are_ready() and time.monotonic() < end:
    executor.spin_once(timeout_sec=0.1)
print([parameter_value_to_python(v) for v in wait(client.get_parameters(['speed'])).values])
print([r.successful for r in wait(client.set_parameters([Parameter('speed', value=2.0)])).results])
print('speed' in wait(client.list_parameters()).result.names)
while not heard:
    executor.spin_once(timeout_sec=0.1)
print(heard)
""",
    "an executor and a callback group of one's own": """
from concurrent.futures import ThreadPoolExecutor
from rclpy.callback_groups import CallbackGroup
from rclpy.executors import Executor, TimeoutException
class Pooled(Executor):
    def __init__(self):
        super().__init__()
        self.pool = ThreadPoolExecutor(max_workers=2)
    def spin_once(self, timeout_sec=None):
        try:
            handler, entity, node = self.wait_for_ready_callbacks(timeout_sec=timeout_sec)
        except TimeoutException:
            return
        self.pool.submit(handler)
class Few(CallbackGroup):
    def __init__(self):
        super().__init__()
        self.left = 2
        self.ended = 0
    def can_execute(self, entity):
        return self.left > 0
    def beginning_execution(self, entity):
        self.left -= 1
        return True
    def ending_execution(self, entity):
        self.ended += 1
rclpy.init()
node = Node('pooled')
group, few, free = Few(), [], []
node.create_timer(0.01, lambda: few.append(1), callback_group=group)
node.create_timer(0.01, lambda: free.append(1))
executor = Pooled()
executor.add_node(node)
while len(free) < 6:
    executor.spin_once(timeout_sec=0.5)
print(len(few), group.left, group.ended)
guard = node.create_guard_condition(lambda: free.append('guard'))
guard.trigger()
while 'guard' not in free:
    executor.spin_once(timeout_sec=0.5)
executor.pool.shutdown()
""",
    "checks of names": """
from rclpy.validate_topic_name import validate_topic_name
from rclpy.validate_node_name import validate_node_name
from rclpy.validate_namespace import validate_namespace
from rclpy.validate_full_topic_name import validate_full_topic_name
from rclpy.expand_topic_name import expand_topic_name
from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden
print(validate_topic_name('chatter'), validate_node_name('talker'), validate_namespace('/ns'))
print(validate_full_topic_name('/chatter'), expand_topic_name('~/x', 'node', '/ns'))
print(topic_or_service_is_hidden('/_hidden'), topic_or_service_is_hidden('/seen'))
for bad in (lambda: validate_topic_name('a b'), lambda: validate_node_name('/a'),
            lambda: validate_namespace('ns'), lambda: validate_full_topic_name('a')):
    try:
        bad()
    except Exception as error:
        print(type(error).__name__)
""",
}
"""By what each is about."""


def script_of(about: str) -> str:
    """The whole text of a program."""
    return _BEGIN + SCRIPTS[about]

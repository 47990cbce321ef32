"""Small programs as students write them: nodes, topics, services, parameters, timers, ends."""

from __future__ import annotations

from typing import Final

SCRIPTS: Final[dict[str, str]] = {
    "talker and listener in one process": """
class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.pub = self.create_publisher(msg_type=String, topic='chatter', qos_profile=10)
        self.timer = self.create_timer(0.05, self.tick)
        self.i = 0
    def tick(self):
        if self.pub.get_subscription_count():
            msg = String()
            msg.data = f'hello {self.i}'
            self.pub.publish(msg)
            self.get_logger().info(f'Publishing: "{msg.data}"')
            self.i += 1

heard = []
rclpy.init(args=sys.argv)
talker = Talker()
listener = Node('listener')
listener.create_subscription(
    msg_type=String, topic='chatter', callback=lambda m: heard.append(m.data), qos_profile=10)
from rclpy.executors import SingleThreadedExecutor
executor = SingleThreadedExecutor()
executor.add_node(talker)
executor.add_node(listener)
while len(heard) < 3:
    executor.spin_once(timeout_sec=0.1)
print(heard[:3])
talker.destroy_node()
listener.destroy_node()
rclpy.shutdown()
""",
    "a node and its names": """
rclpy.init()
node = rclpy.create_node('inside', namespace='/ns')
print(rclpy.ok(), node.get_name(), node.get_namespace(), node.get_fully_qualified_name())
rclpy.shutdown()
print(rclpy.ok())
""",
    "service and client with call_async": """
from example_interfaces.srv import AddTwoInts
rclpy.init()
node = Node('adder')
def add(request, response):
    response.sum = request.a + request.b
    node.get_logger().info(f'{request.a} + {request.b}')
    return response
service = node.create_service(srv_type=AddTwoInts, srv_name='add_two_ints', callback=add)
client = node.create_client(AddTwoInts, 'add_two_ints')
print(client.wait_for_service(timeout_sec=5.0), client.srv_name, service.srv_name)
future = client.call_async(AddTwoInts.Request(a=41, b=1))
print(future.done())
rclpy.spin_until_future_complete(node, future)
print(future.done(), future.result(), future.exception(), future.cancelled())
""",
    "a service that returns nothing": """
from example_interfaces.srv import AddTwoInts
rclpy.init()
node = Node('adder')
def add(request, response):
    response.sum = 3
service = node.create_service(AddTwoInts, 'add_nothing', add)
client = node.create_client(AddTwoInts, 'add_nothing')
client.wait_for_service(5.0)
future = client.call_async(AddTwoInts.Request())
rclpy.spin_until_future_complete(node, future, timeout_sec=3)
print('not reached')
""",
    "a future that is cancelled": """
from example_interfaces.srv import AddTwoInts
rclpy.init()
node = Node('asker')
client = node.create_client(AddTwoInts, 'nobody')
print(client.service_is_ready(), client.wait_for_service(timeout_sec=0.2))
future = client.call_async(AddTwoInts.Request())
future.add_done_callback(lambda f: print('done', f.cancelled()))
rclpy.spin_until_future_complete(node, future, timeout_sec=0.2)
print(future.done())
future.cancel()
print(future.cancelled(), future.result())
rclpy.spin_once(node, timeout_sec=0.1)
""",
    "done callbacks wait for the executor": """
rclpy.init()
node = Node('futures')
from rclpy.task import Future
future = Future()
future.add_done_callback(lambda f: print('callback', f.result()))
future.set_result(5)
print('after set')
other = Future(executor=rclpy.get_global_executor())
other.add_done_callback(lambda f: print('other', f.result()))
other.set_result(6)
print('after other')
rclpy.spin_once(node, timeout_sec=0.1)
""",
    "parameters": """
from rcl_interfaces.msg import SetParametersResult, ParameterDescriptor, IntegerRange
from rclpy.parameter import Parameter
rclpy.init()
node = Node('params')
print(node.declare_parameter('name', 'robot').value)
node.declare_parameter('speed', 1.5)
node.declare_parameter('list', [1, 2, 3])
limits = ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=10, step=2)])
node.declare_parameter('even', 4, limits)
node.declare_parameter('fixed', 1, ParameterDescriptor(read_only=True))
print(node.get_parameter('speed').value, node.get_parameter('speed').type_,
      node.get_parameter('list').value, node.has_parameter('nope'))
print(node.get_parameter_or('nope', Parameter('nope', value=7)).value)
def check(params):
    for p in params:
        print('check', p.name, p.value)
        if p.name == 'speed' and p.value > 2.0:
            return SetParametersResult(successful=False, reason='too fast')
    return SetParametersResult(successful=True)
node.add_on_set_parameters_callback(check)
for p in (Parameter('speed', value=1.0), Parameter('speed', value=9.0), Parameter('even', value=6),
          Parameter('fixed', value=2)):
    [result] = node.set_parameters([p])
    print(p.name, result.successful, result.reason if p.name == 'speed' else '')
print(node.set_parameters([Parameter('even', value=5)])[0].successful,
      node.set_parameters([Parameter('even', value=12)])[0].successful,
      node.set_parameters([Parameter('name', value=3)])[0].successful)
print(node.get_parameter('even').value)
print(node.get_parameter('name').get_parameter_value().string_value)
print(sorted(node.get_parameters_by_prefix('').keys()))
print(node.describe_parameter('even').integer_range[0].to_value)
node.undeclare_parameter('list')
print(node.has_parameter('list'))
""",
    "a parameter declared twice": """
rclpy.init()
node = Node('params')
node.declare_parameter('use_sim_time', False)
""",
    "a parameter not declared": """
rclpy.init()
node = Node('params')
node.get_parameter('nope')
""",
    "a parameter of a type without a value": """
from rclpy.parameter import Parameter
rclpy.init()
node = Node('params')
node.declare_parameter('typed', Parameter.Type.INTEGER)
try:
    node.get_parameter('typed')
except Exception as error:
    print(type(error).__name__)
try:
    node.declare_parameter('typed2', Parameter.Type.STRING)
    node.set_parameters_atomically([Parameter('typed2', value=3)])
    print(node.get_parameter('typed2').value)
except Exception as error:
    print(type(error).__name__)
try:
    node.set_parameters([Parameter('unknown', value=3)])
except Exception as error:
    print(type(error).__name__)
""",
    "arguments of the command line": """
sys.argv[1:] = [
    'own', '--ros-args', '-r', '__node:=renamed', '-r', '__ns:=/space', '-r', 'chatter:=/x',
    '-p', 'speed:=2.5', '-p', 'words:=[a, b]', '--log-level', 'debug', '--', 'more']
rclpy.init()
node = Node('first')
print(node.get_fully_qualified_name(), node.resolve_topic_name('chatter'),
      node.resolve_topic_name('other'), node.resolve_topic_name('~/private'))
print(node.declare_parameter('speed', 1.0).value, node.declare_parameter('words', ['']).value)
node.get_logger().debug('seen')
from rclpy.utilities import remove_ros_args
print(remove_ros_args(sys.argv)[1:])
""",
    "a wrong argument of ROS": """
rclpy.init(args=['--ros-args', '--nonsense'])
""",
    "spinning within a callback": """
rclpy.init()
node = Node('nested')
def within():
    timer.cancel()
    try:
        rclpy.spin_once(node, timeout_sec=0.1)
    except RuntimeError as error:
        print(type(error).__name__, error)
    raise SystemExit(7)
timer = node.create_timer(0.01, within)
rclpy.spin(node)
""",
    "spinning in two threads": """
rclpy.init()
node = Node('twice')
from rclpy.executors import ExternalShutdownException
def spin():
    try:
        rclpy.spin(node)
    except ExternalShutdownException:
        pass
thread = threading.Thread(target=spin, daemon=True)
thread.start()
while not rclpy.get_global_executor()._is_spinning:
    time.sleep(0.01)
try:
    rclpy.spin_once(node, timeout_sec=0.1)
except RuntimeError as error:
    print(type(error).__name__, error)
rclpy.shutdown()
thread.join()
""",
    "a timer and its methods": """
rclpy.init()
node = Node('timers')
ticks = []
timer = node.create_timer(0.02, lambda: ticks.append(1))
print(timer.timer_period_ns, timer.is_canceled())
while len(ticks) < 3:
    rclpy.spin_once(node)
timer.cancel()
print(timer.is_canceled())
before = len(ticks)
rclpy.spin_once(node, timeout_sec=0.1)
print(len(ticks) == before)
timer.reset()
rclpy.spin_once(node, timeout_sec=1)
print(len(ticks) > before, node.destroy_timer(timer))
""",
    "a rate in a thread": """
rclpy.init()
node = Node('rates')
from rclpy.executors import ExternalShutdownException
def spin():
    try:
        rclpy.spin(node)
    except ExternalShutdownException:
        pass
thread = threading.Thread(target=spin, daemon=True)
thread.start()
rate = node.create_rate(50)
start = time.monotonic()
for _ in range(5):
    rate.sleep()
print(0.05 < time.monotonic() - start < 1.0)
rclpy.shutdown()
thread.join()
print('joined')
""",
    "callback groups in threads": """
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from example_interfaces.srv import AddTwoInts
rclpy.init()
node = Node('groups')
one, two = MutuallyExclusiveCallbackGroup(), ReentrantCallbackGroup()
def add(request, response):
    response.sum = request.a + request.b
    return response
node.create_service(AddTwoInts, 'grouped', add, callback_group=two)
client = node.create_client(AddTwoInts, 'grouped', callback_group=two)
done = threading.Event()
def ask():
    timer.cancel()
    client.wait_for_service(5)
    print(client.call(AddTwoInts.Request(a=1, b=2)).sum)
    done.set()
timer = node.create_timer(0.01, ask, callback_group=one)
executor = MultiThreadedExecutor(num_threads=3)
executor.add_node(node)
while not done.is_set():
    executor.spin_once(timeout_sec=0.1)
print(len(executor.get_nodes()))
executor.shutdown()
""",
    "spin without a node left": """
rclpy.init()
node = Node('spun')
count = []
node.create_timer(0.01, lambda: (count.append(1), rclpy.shutdown() if len(count) == 3 else None))
try:
    rclpy.spin(node)
except BaseException as error:
    print(type(error).__name__)
print(len(count), rclpy.ok())
""",
    "an exception in a callback": """
rclpy.init()
node = Node('broken')
def fall():
    raise ValueError('in a callback')
node.create_timer(0.01, fall)
rclpy.spin(node)
""",
    "exit codes": """
rclpy.init()
node = Node('leaving')
sys.exit(3)
""",
}
"""By what each is about."""

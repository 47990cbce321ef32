"""Small programs about topics within callbacks, about one's own graph, and about logs by place."""

from __future__ import annotations

from typing import Final

SCRIPTS: Final[dict[str, str]] = {
    "wait_for_message within a callback": """
from rclpy.wait_for_message import wait_for_message
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
rclpy.init()
speaker = Node('speaker')
pub = speaker.create_publisher(String, 'said', 10)
speaker.create_timer(0.02, lambda: pub.publish(String(data='a word')))
def speak():
    executor = SingleThreadedExecutor()
    executor.add_node(speaker)
    try:
        executor.spin()
    except ExternalShutdownException:
        pass
thread = threading.Thread(target=speak)
thread.start()
node = Node('asker')
def ask():
    timer.cancel()
    print(wait_for_message(String, node, 'said', time_to_wait=5))
    print(wait_for_message(String, node, 'never_said', time_to_wait=0.1))
    raise SystemExit(0)
timer = node.create_timer(0.01, ask)
try:
    rclpy.spin(node)
finally:
    rclpy.try_shutdown()
    thread.join()
""",
    "wait_for_message for ever, and with an executor that does not spin": """
from rclpy.wait_for_message import wait_for_message
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
rclpy.init()
idle = SingleThreadedExecutor()
node = Node('asker')
idle.add_node(node)
speaker = Node('speaker')
pub = speaker.create_publisher(String, 'said', 10)
speaker.create_timer(0.02, lambda: pub.publish(String(data='a word')))
def speak():
    try:
        rclpy.spin(speaker)
    except ExternalShutdownException:
        pass
thread = threading.Thread(target=speak)
thread.start()
print(wait_for_message(String, node, 'said', time_to_wait=-1))
print(wait_for_message(String, node, 'said'))
rclpy.shutdown()
thread.join()
""",
    "one's own nodes and endpoints are in the graph at once": """
from example_interfaces.srv import AddTwoInts
rclpy.init()
node = Node('seen')
print([name for name in node.get_node_names() if name in ('seen', 'other')])
pub = node.create_publisher(String, 'own_topic', 10)
print(node.count_publishers('own_topic'), node.count_subscribers('own_topic'))
sub = node.create_subscription(String, 'own_topic', lambda m: None, 10)
print(pub.get_subscription_count(), sub.get_publisher_count())
print([info.node_name for info in node.get_publishers_info_by_topic('own_topic')])
client = node.create_client(AddTwoInts, 'own_service')
print(client.service_is_ready(), node.count_clients('own_service'))
service = node.create_service(AddTwoInts, 'own_service', lambda request, response: response)
print(client.service_is_ready(), node.count_services('own_service'))
other = Node('other')
print([name for name in node.get_node_names() if name in ('seen', 'other')])
print(('/own_topic', ['std_msgs/msg/String']) in node.get_topic_names_and_types())
for end in (pub, sub, service, client):
    kind = type(end).__name__.lower()
    print(kind, getattr(node, f'destroy_{kind}')(end), node.count_publishers('own_topic'),
          node.count_subscribers('own_topic'), node.count_services('own_service'),
          node.count_clients('own_service'))
other.destroy_node()
print([name for name in node.get_node_names() if name in ('seen', 'other')])
rclpy.shutdown()
""",
    "limits of logs": """
from rclpy.clock import Clock
from rclpy.logging import get_logger
rclpy.init()
node = Node('limits')
log = node.get_logger()
for i in range(3):
    print(log.info(f'throttled and skipped {i}', throttle_duration_sec=60.0, skip_first=True))
for i in range(3):
    print(log.info(f'throttled {i}', throttle_duration_sec=60.0), log.info(f'also {i}', once=True))
for i in range(3):
    print(log.info(f'once and skipped {i}', once=True, skip_first=True))
for i in range(3):
    print(log.warning('a', once=True), log.warning('b', once=True))
for i in range(4):
    print(log.error(f'short {i}', throttle_duration_sec=0.15, throttle_time_source_type=Clock()))
    time.sleep(0.1)
for i in range(2):
    get_logger('anew').info(f'anew {i}', once=True)
    log.get_child('part').info(f'part {i}', once=True)
log.info('in another name', name='other')
""",
    "logs that change at one place": """
rclpy.init()
node = Node('changing')
log = node.get_logger()
severities = rclpy.logging.LoggingSeverity
def say(*values, **more):
    try:
        print(log.log(*values, **more))
    except Exception as error:
        print(type(error).__name__, error)
say('first', severities.INFO)
say('second', severities.WARN)
say('third', severities.DEBUG)
say('fourth', severities.INFO, once=True)
for duration in (1.0, 2.0):
    try:
        print(log.info('x', throttle_duration_sec=duration))
    except ValueError as error:
        print(error)
for name in ('one', 'two'):
    try:
        print(log.info('x', name=name))
    except ValueError as error:
        print(error)
for more in ({'nonsense': 1}, {'throttle_time_source_type': node.get_clock()},
             {'throttle_time_source_type': 'x', 'throttle_duration_sec': 1.0}):
    try:
        log.info('x', **more)
    except (TypeError, ValueError) as error:
        print(type(error).__name__)
try:
    log.get_child('')
except ValueError as error:
    print(type(error).__name__)
""",
    "callbacks that cannot be called": """
rclpy.init()
node = Node('calling')
def three(a, b, c):
    pass
def two(a, b):
    pass
for given in (None, 3, 'x', lambda: None, three, two, lambda *a: None, print):
    try:
        subscription = node.create_subscription(String, 'topic', given, 10)
        print(node.destroy_subscription(subscription))
    except Exception as error:
        print(type(error).__name__ if isinstance(error, ValueError) else
              isinstance(error, RuntimeError))
for add in (node.add_on_set_parameters_callback, node.add_post_set_parameters_callback):
    try:
        add(None)
    except TypeError:
        print('TypeError')
""",
    "fields that are checked": """
made = String(data='x', check_fields=True)
print(made, made == String(data='x'))
for make in (lambda: String(data=3, check_fields=True),
             lambda: Int32(data='x', check_fields=True)):
    try:
        make()
    except AssertionError:
        print('AssertionError')
""",
    "parameters from a file": """
import os, tempfile
from rclpy.parameter import parameter_dict_from_yaml_file, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
text = '''
/one:
  ros__parameters: {count: 3, deep: {er: 1.5}}
/ns:
  two:
    ros__parameters: {words: [a, b]}
/**:
  ros__parameters: {count: 9, all: true}
'''
handle, path = tempfile.mkstemp('.yaml')
with os.fdopen(handle, 'w') as file:
    file.write(text)
def shown(found):
    return sorted((name, parameter_value_to_python(one.value)) for name, one in found.items())
print(shown(parameter_dict_from_yaml_file(path)))
print(shown(parameter_dict_from_yaml_file(path, use_wildcard=True)))
print(shown(parameter_dict_from_yaml_file(path, target_nodes=['/one'])))
print(shown(parameter_dict_from_yaml_file(path, True, ['/ns/two'], 'x.')))
try:
    parameter_dict_from_yaml_file(path, target_nodes=['/three'])
except RuntimeError:
    print('RuntimeError')
rclpy.init()
served = Node('served', allow_undeclared_parameters=True)
client = AsyncParameterClient(served, 'served')
print(client.wait_for_services(5.0))
future = client.load_parameter_file(path)
rclpy.spin_until_future_complete(served, future)
print([one.successful for one in future.result().results])
print(served.get_parameter('count').value, served.get_parameter('deep.er').value)
os.unlink(path)
""",
}
"""By what each is about."""

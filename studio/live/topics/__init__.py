"""Topics of a ROS 2 system, a recording or another studio, taken by panels and displays alike.

Whoever wants messages asks a `TopicSource` with a `Request` and holds a `Subscription`.
"""

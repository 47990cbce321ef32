"""Students' own nodes: a router of their own beside the class, a ROS domain for each person.

The router is another Zenoh network than that of the robot, in a process of its own. It lets in who
has a certificate of the pool, and each only into one domain.
"""

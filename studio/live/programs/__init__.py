"""What the owner runs out of the page: launch files planned and started, nodes, their packages."""

"""XML and YAML launch files, read into the same vocabulary as Python's."""

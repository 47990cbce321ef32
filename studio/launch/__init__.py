"""Launch files: what they would start (a plan), and starting it as one group."""

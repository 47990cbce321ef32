"""xacro as a function of files and arguments: what comes out of source trees, every read kept."""

"""The texts of a package in, what a new node, interface or file changes in them out."""

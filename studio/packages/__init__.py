"""Packages by name, URIs to files, the folders that may be read, zips."""

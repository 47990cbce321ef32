"""Mesh files of any format in, one LoadedMesh out: read in a worker, cached on the disk."""

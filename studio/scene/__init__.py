"""The 3D view: viser in our process, drawings to viser nodes; the only room that imports viser."""

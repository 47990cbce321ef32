"""Xacro text in, URDF parts with their origins out; the only room that imports xacro."""

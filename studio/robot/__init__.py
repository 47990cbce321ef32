"""Links, joints, kinematics, meshes: the only room that imports yourdfpy and trimesh."""

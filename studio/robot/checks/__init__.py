"""A robot's values in, findings out: limits, masses, shapes and meshes that no machine can have."""

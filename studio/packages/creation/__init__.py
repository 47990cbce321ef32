"""What a person wants of a new package in, the package that colcon builds out."""

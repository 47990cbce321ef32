"""`python -m studio.nodes.demos.rover`: the rover, until it is stopped."""

from studio.nodes.demos.rover import main

main()

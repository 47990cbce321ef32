"""`python -m studio.course.rover`: the rover, until it is stopped."""

from studio.course.rover import main

main()

"""Private copies of an open document, one for each person of a class, to try things on."""

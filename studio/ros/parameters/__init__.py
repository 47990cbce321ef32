"""Parameters of nodes: names and values in, changes and refusals out, here and over the wire."""

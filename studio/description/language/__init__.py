"""Editor support: what a name in a text means, where it is defined, how it can be completed."""

"""What RViz has beside displays, as values: its tools, its views and its config files."""

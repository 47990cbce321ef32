"""How a document's joints stand: set, swung, led to a pose; and the poses with names."""

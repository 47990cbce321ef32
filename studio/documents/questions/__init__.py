"""What the page asks of a document and its texts, answered as the worker is free."""

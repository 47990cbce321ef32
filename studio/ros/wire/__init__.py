"""The Zenoh side: which router, how a session is opened and closed, and the router of our own."""

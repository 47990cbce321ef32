"""RViz's displays: each takes the messages of its topics and returns a Drawing of them."""

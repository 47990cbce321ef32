"""Liveliness tokens in; the nodes, topics, services and actions of a domain out."""

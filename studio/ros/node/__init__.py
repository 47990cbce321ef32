"""Nodes: publishers, subscriptions, services, timers and clocks, and who carries out their work."""

"""Turtles that draw: Twist and service calls in, poses, colours and the picture they drew out."""

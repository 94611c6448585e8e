"""Shapes: paths by arc length, oriented boxes, and the conflict zones between routes."""

"""The roads, and from a seed the vehicles that start on them."""

"""People: how human drivers differ, when they see what, and what they make of it."""

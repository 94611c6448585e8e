"""From situations to decisions."""

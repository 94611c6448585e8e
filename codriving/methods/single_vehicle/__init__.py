"""A vehicle on its own: drivers that see the others and know nothing of what they mean to do."""

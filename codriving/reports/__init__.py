"""Records to tables: everything a reader sees, redrawn from what is stored, without a simulator."""

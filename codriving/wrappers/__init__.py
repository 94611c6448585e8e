"""What is put around a method: the safety check behind it, and the time that it takes to think."""

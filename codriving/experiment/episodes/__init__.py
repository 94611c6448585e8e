"""Episodes and batches of them: the only loop, and the processes that it runs in."""

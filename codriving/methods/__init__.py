"""Methods: every row of a table is a pipeline with other objects in its slots."""

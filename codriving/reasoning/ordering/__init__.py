"""From the conflict list to a passing order: the paper's conflict coordinator, and what stands in without it."""

"""Speed, measured against a rival that is stepped alternately in the same run."""

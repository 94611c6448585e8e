"""From a passing order to the actions of all CAVs: what every method that orders shares."""

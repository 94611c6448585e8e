"""The fuzzy coalition: all CAVs choose their accelerations together, without an order."""

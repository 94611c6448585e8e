"""The near future without the simulator."""

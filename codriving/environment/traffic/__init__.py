"""Human drivers: how they follow routes, give way and change lanes."""

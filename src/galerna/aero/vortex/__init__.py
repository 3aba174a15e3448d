"""The unsteady vortex lattice: lifting surfaces and free wakes as sheets of vortex rings."""

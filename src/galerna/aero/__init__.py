"""Wind to loads on blades and tower."""

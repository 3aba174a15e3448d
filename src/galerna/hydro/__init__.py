"""Water on the platform: hydrostatics, radiation, waves, drag, moorings."""

"""Wind, structure, drivetrain and controller made one machine."""

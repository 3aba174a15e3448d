"""Who commands the machine: torque and pitch control, actuators, and their design."""

"""What is simulated: plain data, no numerics."""

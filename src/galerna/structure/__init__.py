"""How the machine moves."""

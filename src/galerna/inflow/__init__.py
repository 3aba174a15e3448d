"""Undisturbed wind at any point and time."""

"""Blade-element momentum theory and its corrections."""

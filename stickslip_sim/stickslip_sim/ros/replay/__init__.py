"""Recorded runs back onto topics, or their commands into a live node."""

"""Advice: what each part of a scene changes and costs, and the least scene and solver for a tolerance."""

"""Recorded runs, run again from what travels in them: the same to the last bit, or as something else had been."""

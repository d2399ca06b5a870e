"""Pass or fail: what an axis did, recorded or simulated, against the limits in a file."""

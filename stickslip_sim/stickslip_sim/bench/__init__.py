"""The measured trade: what every solver costs and how wrong it is, against the reference and against its peers."""

"""Where the catalogue ends: a law of the rest, learned from the data and held to its rules."""

"""Many logs: what is to be done of each, where it is done, and what was done already."""

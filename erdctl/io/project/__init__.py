"""`erdctl.toml`: what a lab says once of its columns, limits, options and names of files.

`find` looks for it, `read_project` reads it, and `Project` says what of it holds for a log.
"""

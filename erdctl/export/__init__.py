"""Models and emulators for other programs: C source, FMUs, tables."""

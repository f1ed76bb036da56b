"""What was identified, for other programs: C, FMU, emulator, tables."""

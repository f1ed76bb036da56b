"""Identified dampers for other programs: C, FMU, the online emulator, and tables."""

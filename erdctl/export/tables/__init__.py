"""What a vehicle program can look up: force over speed and duty, as .dpr, CSV and MAT."""

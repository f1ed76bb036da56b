"""What a test shows of a damper, and how one is driven: strokes, drives, dyno curves."""

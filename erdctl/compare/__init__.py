"""What changed: one parameter over months, two states of a damper, a damper and its tolerances."""

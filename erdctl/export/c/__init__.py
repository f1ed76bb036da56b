"""A damper's model as C99 source."""

"""Laws that nobody wrote: a curve over a coordinate of the motion, in one slot of the model."""

"""What a model leaves: whether motion predicts it, what it looks like, where it is."""

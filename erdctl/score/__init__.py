"""How well a model does: NRMSE and its splits, where it misses, the yield force by level."""

"""Locate a mismatch, name the physics left out, model it, prove it on what the fit has not seen."""

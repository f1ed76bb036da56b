"""The version of erdctl, which documents state."""

__version__ = "0.1.0"

"""erdctl: identify, simulate, validate and diagnose electro-rheological dampers."""

__version__ = "0.1.0"

"""Files and streams: bench logs in, tables and documents out; the only place that knows units."""

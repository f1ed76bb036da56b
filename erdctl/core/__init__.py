"""What everything stands on: errors, parameters' declarations, data in memory, worker processes."""

"""What people look at; knows result objects only."""

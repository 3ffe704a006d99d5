"""What survives a restart: one SQLite file, and results beside it named by their content."""

"""Solving and simulating in worker processes: queues, deadlines, cancelling, crashes, caching."""

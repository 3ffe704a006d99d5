"""What stops the robot: the single change that would open the way."""

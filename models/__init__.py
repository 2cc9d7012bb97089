"""What the robot and its table are: descriptions from installed packages, scene and appearance."""

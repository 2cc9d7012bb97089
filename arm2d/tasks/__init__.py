"""What is asked in a world, and how it is said: the paper's two conditions, and tasks of one's own."""

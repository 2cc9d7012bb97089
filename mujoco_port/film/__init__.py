"""What is seen: the stage, captions, videos, galleries and the two ports."""

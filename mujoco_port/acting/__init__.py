"""The robot acts: motors, contacts, eyes, open and closed loop, the verdict in three dimensions."""

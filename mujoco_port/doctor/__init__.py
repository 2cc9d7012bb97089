"""What this machine has, what it lacks, and what to do about it; imports nothing that may be missing."""

"""Many runs: what a file asks for, their plan, how far they are, and the jobs that carry it out."""

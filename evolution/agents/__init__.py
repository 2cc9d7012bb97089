"""What evolved agents do: the paper's tests, ancestors, behaviour, lesions."""

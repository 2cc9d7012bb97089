"""The network as parameters: which genes stand for which, in networks of any size, and their values."""

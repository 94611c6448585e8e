"""What learned drivers see, the networks that judge it, and the trained weights that are shipped; knows no PyTorch."""

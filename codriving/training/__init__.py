"""Training of learned drivers, on the environment for agents; PyTorch is imported only while it goes on."""

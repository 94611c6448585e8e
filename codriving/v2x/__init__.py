"""Messages between CAVs: the channel, what each CAV knows through it, and a method that decides by that."""

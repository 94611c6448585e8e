"""What a run leaves on disk: whole or not at all, strict when read again."""

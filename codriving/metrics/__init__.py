"""From a driven trajectory to its score: success, post-encroachment time, travel velocity."""

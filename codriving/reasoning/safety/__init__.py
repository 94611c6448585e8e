"""The three-layer action safety assessment of the paper (Section III-C.4)."""

"""The cooperative game: streams of vehicles form coalitions that choose the passing order."""

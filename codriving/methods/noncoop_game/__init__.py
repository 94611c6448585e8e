"""The non-cooperative game of a single vehicle against its most urgent partner."""

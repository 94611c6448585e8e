"""Questions to a language model and its answers: prompts, requests, retries, limits, costs and parsing."""

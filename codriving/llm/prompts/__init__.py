"""What language models are told: templates in files, filled with what the rules get as well."""

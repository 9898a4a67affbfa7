"""Looking at records: what they are, what is wrong with them, what they can show."""

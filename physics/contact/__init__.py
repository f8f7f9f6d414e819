"""Balls between their races: where they are (`track`), what presses them (`forces`), which touch (`contact_set`)."""

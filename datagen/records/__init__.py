"""From a scenario to one record: simulated, given its background, described by labels and exact truth."""

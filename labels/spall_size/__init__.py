"""How long a spall is, from one record of vibration: event times, their lag, and the arc that goes with it.

- `situation`: what the person asking knows; `size_estimate`: the answer
- `static_release`: from lag to length; `known_size`: better with a measured spall
- `event_truth`: the events of simulated records, to compare with

Each of the rooms imports from those before it:

- `signal/`: from the record to its mean pass
- `events/`: candidates in the mean pass and pairs of them
- `columns/`: what describes a pair, joined by name in `columns.table`
- `estimation/`: which pair is taken, and the size that goes with it
"""

"""How long a spall is, from one record of vibration: event times, their lag, and the arc that goes with it.

What an estimate does from start to end (`estimation.gathering`, then `estimation.estimator`): the record is
prewhitened; ball passes are tracked for either race, and the clearer race is taken; passes are lined up and averaged;
places in the mean pass where events may be are paired; trees score all pairs and rank the leading ones by more
evidence; the first of them is taken for the events if the error to be expected of its lag is small enough; lag and arc
are corrected by what was learned, and get their intervals.

- `situation`: what the person asking knows; `size_estimate`: the answer
- `static_release`: from lag to length; `known_size`: better with a measured spall
- `event_truth`: the events of simulated records, to compare with

Each of the rooms imports from those before it:

- `signal/`: from the record to its mean pass
- `events/`: candidates in the mean pass and pairs of them
- `columns/`: what describes a pair, joined by name in `columns.table`
- `estimation/`: which pair is taken, and the size that goes with it
"""

"""What pairs of events are judged by: columns in groups, joined by one `table`.

- of all pairs: `record`, `levels`, `likeness`, `motion`, `event_shapes`
- of leading ones: `event_profiles`, `rivals`, `length`, `load`
- of the one taken for the events: `choice`
"""
